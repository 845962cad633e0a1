#include "experiments/program_json.h"

#include <nlohmann/json.hpp>

#include "experiments/build_facts.h"

namespace plumb {

nlohmann::ordered_json program_json() {
    const BuildFacts& build = build_facts();
    return {{"version", build.version},
            {"git", build.git_describe},
            {"compiler", build.compiler},
            {"build_type", build.build_type},
            {"integrator_hash", build.integrator_hash}};
}

}  // namespace plumb

#include "experiments/run_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "experiments/build_facts.h"

namespace plumb {

nlohmann::ordered_json number_json(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json run_json(const std::string& command, const std::string& started, double seconds,
                                const SystemFacts& system) {
    const BuildFacts& build = build_facts();
    return {{"program",
             {{"version", build.version},
              {"git", build.git_describe},
              {"compiler", build.compiler},
              {"build_type", build.build_type},
              {"integrator_hash", build.integrator_hash}}},
            {"command", command},
            {"started", started},
            {"seconds", seconds},
            {"machine",
             {{"cpu", system.cpu},
              {"logical_cores", system.logical_cores},
              {"worker_threads", system.worker_threads},
              {"memory_bytes", system.memory_bytes},
              {"operating_system", system.operating_system},
              {"embree", system.embree}}}};
}

nlohmann::ordered_json failures_json(const std::vector<CellFailure>& failures) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const CellFailure& failure : failures) json.push_back({{"cell", failure.cell}, {"message", failure.message}});
    return json;
}

}  // namespace plumb

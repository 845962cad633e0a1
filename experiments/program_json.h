// What made a result, as result files tell it.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace plumb {

// build_facts() under their names: version, git, compiler, build_type, integrator_hash.
nlohmann::ordered_json program_json();

}  // namespace plumb

// What made a result, when and on what, as result files tell it.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "experiments/results.h"
#include "experiments/system_facts.h"

namespace plumb {

// JSON has no infinities and no NaN: null stands for them.
nlohmann::ordered_json number_json(double value);

// For files that are read by people and by version control, too, and are large: objects of the outer two levels have a
// line for each member, lists of objects within them one for each element, and whatever is inside is on that line.
// Bytes that are no UTF-8 (a file name) are replaced rather than losing all results.
std::string print_json_lines(const nlohmann::ordered_json& json);

// program (build_facts() under their names: version, git, compiler, build_type, integrator_hash), command, started,
// seconds, and machine.
nlohmann::ordered_json run_json(const std::string& command, const std::string& started, double seconds,
                                const SystemFacts& system);

nlohmann::ordered_json failures_json(const std::vector<CellFailure>& failures);

}  // namespace plumb

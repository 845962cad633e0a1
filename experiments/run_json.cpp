#include "experiments/run_json.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/build_facts.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

std::string on_one_line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string in_lines(const Json& json, int levels, const std::string& indent) {
    const bool is_list = json.is_array() && std::ranges::any_of(json, &Json::is_structured);
    if (json.empty() || !(is_list || (json.is_object() && levels > 0))) return on_one_line(json);
    const std::string inner = indent + "  ";
    std::string text;
    for (const auto& [key, value] : json.items()) {
        text += text.empty() ? "\n" : ",\n";
        text += is_list ? inner + on_one_line(value)
                        : fmt::format("{}{}: {}", inner, on_one_line(key), in_lines(value, levels - 1, inner));
    }
    return fmt::format("{}{}\n{}{}", is_list ? '[' : '{', text, indent, is_list ? ']' : '}');
}

}  // namespace

std::string print_json_lines(const Json& json) { return in_lines(json, 2, "") + "\n"; }

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

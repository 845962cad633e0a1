#include "experiments/recorded_run.h"

#include <cmath>
#include <fstream>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/build_facts.h"
#include "experiments/no_value.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

std::string key_of(const std::string& scene, const std::string& place, const std::string& plane,
                   const std::string& truth, const std::string& method) {
    return fmt::format("{} / {} / {}{} / {}", scene, place, plane, truth.empty() ? "" : fmt::format(" ({})", truth),
                       method);
}

double recorded_number(const Json& json) { return json.is_null() ? no_value : json.get<double>(); }

// The same bits, or neither finite: JSON has no infinities.
bool same(double a, double b) { return a == b || (!std::isfinite(a) && !std::isfinite(b)); }

// Empty where all measures are the same.
std::string first_difference(const std::vector<std::pair<std::string, double>>& recorded,
                             const std::vector<std::pair<std::string, double>>& now) {
    for (const auto& [name, value] : now) {
        const auto found = std::ranges::find(recorded, name, &std::pair<std::string, double>::first);
        if (found == recorded.end()) return fmt::format("{} was not recorded", name);
        if (!same(found->second, value)) return fmt::format("{} was {:.17g}, is {:.17g}", name, found->second, value);
    }
    return "";
}

void read_rows(const Json& json, RecordedRun& run) {
    for (const Json& row : json.at("rows")) {
        const std::string place = row.value("path", row.at("view").get<std::string>());
        auto& measures =
            run.measures[key_of(row.at("scene"), place, row.at("plane"), row.at("truth"), row.at("method"))];
        for (const auto& [name, value] : row.at("measures").items())
            measures.emplace_back(name, recorded_number(value));
    }
}

}  // namespace

RecordedRun read_recorded_run(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream) throw ConfigError(fmt::format("cannot read '{}'; does it exist?", file.string()));
    const Json json = Json::parse(stream, nullptr, false);
    if (json.is_discarded()) throw ConfigError(fmt::format("'{}' is no JSON, or only a part of a file", file.string()));
    try {
        RecordedRun run;
        run.experiment_text = json.at("experiment_text");
        if (run.experiment_text.empty()) throw ConfigError("its experiment is empty");
        const Json& experiment = json.at("experiment");
        const std::string source = experiment.at("file");
        run.experiment = parse_experiment(parse_config(run.experiment_text, source), source);
        run.experiment.name = experiment.at("name");
        if (experiment.at("quick")) make_quick(run.experiment);
        run.git_describe = json.at("program").at("git"), run.integrator_hash = json.at("program").at("integrator_hash");
        run.gl_renderer = json.at("gl").at("renderer");
        run.scene_hashes = json.at("scene_hashes");
        read_rows(json, run);
        return run;
    } catch (const std::exception& error) {
        throw ConfigError(
            fmt::format("'{}' cannot be run again: {}; it has to be the results.json of a run that "
                        "compared methods",
                        file.string(), error.what()));
    }
}

RunDifference difference(const RecordedRun& recorded, const RunResults& results) {
    RunDifference difference;
    std::set<std::string> found;
    for (const ResultRow& row : results.rows) {
        const std::string key = key_of(row.scene, row.place(), row.plane, row.truth, row.method);
        const auto before = recorded.measures.find(key);
        if (before == recorded.measures.end()) {
            difference.rows_apart.push_back(fmt::format("{}: was not there", key));
            continue;
        }
        found.insert(key);
        ++difference.rows;
        const std::string apart = first_difference(before->second, row.measures);
        if (!apart.empty()) difference.rows_apart.push_back(fmt::format("{}: {}", key, apart));
    }
    for (const auto& [key, measures] : recorded.measures) {
        if (!found.contains(key)) difference.rows_apart.push_back(fmt::format("{}: is not there any more", key));
    }
    const auto compare = [&](const std::string& what, const std::string& before, std::string_view now) {
        if (before != now) difference.causes.push_back(fmt::format("{}: was {}, is {}", what, before, now));
    };
    compare("program", recorded.git_describe, build_facts().git_describe);
    compare("path tracer's sources", recorded.integrator_hash, build_facts().integrator_hash);
    compare("OpenGL renderer", recorded.gl_renderer, results.gl_renderer);
    for (const auto& [scene, hash] : results.scene_hashes) {
        const auto before = recorded.scene_hashes.find(scene);
        if (before != recorded.scene_hashes.end()) compare(fmt::format("scene '{}'", scene), before->second, hash);
    }
    return difference;
}

}  // namespace plumb

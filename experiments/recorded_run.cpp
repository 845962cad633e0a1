#include "experiments/recorded_run.h"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/build_facts.h"
#include "experiments/result_files.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

std::string key_of(const Json& row) {
    const auto text = [&](const char* name) { return row.at(name).get<std::string>(); };
    const std::string truth = text("truth");
    return fmt::format("{} / {} / {}{} / {}", text("scene"), row.value("path", text("view")), text("plane"),
                       truth.empty() ? "" : fmt::format(" ({})", truth), text("method"));
}

// Every value of a row by its place in the row. Numbers are written so that no two have the same text; what is not
// finite is null.
std::map<std::string, std::string> values_of_row(Json row) {
    row.erase("milliseconds");  // never comes out the same
    const Json flat = row.flatten();
    std::map<std::string, std::string> values;
    for (const auto& [pointer, value] : flat.items()) {
        std::string name = pointer.substr(1);
        std::ranges::replace(name, '/', '.');
        values.emplace(std::move(name), value.dump());
    }
    return values;
}

std::map<std::string, std::map<std::string, std::string>> rows_of(const Json& results) {
    std::map<std::string, std::map<std::string, std::string>> rows;
    for (const Json& row : results.at("rows")) rows[key_of(row)] = values_of_row(row);
    return rows;
}

// Empty where all values are the same.
std::string first_difference(const std::map<std::string, std::string>& recorded,
                             const std::map<std::string, std::string>& now) {
    for (const auto& [name, value] : now) {
        const auto found = recorded.find(name);
        if (found == recorded.end()) continue;  // measured only since
        if (found->second != value) return fmt::format("{} was {}, is {}", name, found->second, value);
    }
    for (const auto& entry : recorded) {
        if (!now.contains(entry.first)) return fmt::format("{} is not there any more", entry.first);
    }
    return "";
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
        run.experiment = parse_experiment(parse_config(run.experiment_text, source), source,
                                          json.value("method_files", MethodFiles{}));
        run.experiment.name = experiment.at("name");
        if (experiment.at("quick")) make_quick(run.experiment);
        run.git_describe = json.at("program").at("git"), run.integrator_hash = json.at("program").at("integrator_hash");
        run.gl_renderer = json.at("gl").at("renderer");
        run.scene_hashes = json.at("scene_hashes");
        run.rows = rows_of(json);
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
    difference.rows = static_cast<int>(recorded.rows.size());
    const auto rows = rows_of(Json::parse(print_json(results)));
    for (const auto& [key, values] : rows) {
        const auto before = recorded.rows.find(key);
        if (before == recorded.rows.end()) {
            difference.rows_apart.push_back(fmt::format("{}: was not there", key));
            continue;
        }
        const std::string apart = first_difference(before->second, values);
        if (apart.empty())
            ++difference.same;
        else
            difference.rows_apart.push_back(fmt::format("{}: {}", key, apart));
    }
    for (const auto& entry : recorded.rows) {
        if (!rows.contains(entry.first))
            difference.rows_apart.push_back(fmt::format("{}: is not there any more", entry.first));
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

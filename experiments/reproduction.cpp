#include "experiments/reproduction.h"

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "embedded/reproductions.h"
#include "experiments/build_facts.h"
#include "experiments/counted_measures.h"
#include "experiments/experiment_file.h"
#include "experiments/generation.h"
#include "scenes/scene_error.h"

namespace plumb {
namespace {

// What an experiment's cells can be called.
struct CellNames {
    std::map<std::string, std::vector<std::string>>
        of;  // attribute to names; attributes that are not here go unchecked
};

CellNames names_of(const Experiment& experiment) {
    CellNames names;
    for (const ExperimentScene& scene : experiment.scenes) names.of["scene"].push_back(scene.scene);
    for (const Method& method : experiment.methods) names.of["method"].push_back(method.name);
    for (const char* curve : {"path tracer", "oracle, bounces"}) names.of["curve"].emplace_back(curve);
    for (const auto& entry : experiment.sweep_points) names.of["curve"].push_back(entry.second.curve);
    names.of["plane"] = experiment.planes;
    names.of["truth"] = {"full", "limited"};
    return names;
}

CellNames names_of(const GenerationExperiment& experiment) {
    CellNames names;
    for (const GenerationWalk& walk : experiment.walks) {
        names.of["scene"].push_back(walk.scene);
        names.of["place"].push_back(walk.name);
    }
    for (const Method& method : experiment.methods) names.of["method"].push_back(method.name);
    return names;
}

// A misspelt name would select nothing, and be noticed after minutes of rendering.
void require_known(const Selector& selector, const CellNames& names, const std::filesystem::path& file,
                   const std::string& where) {
    for (const auto& [attribute, values] : selector.wanted) {
        const auto known = names.of.find(attribute);
        if (known == names.of.end()) continue;
        for (const std::string& value : values) {
            if (std::ranges::find(known->second, value) != known->second.end()) continue;
            if (attribute == "method" && (value.starts_with("path tracer") || value.starts_with("oracle"))) continue;
            throw ConfigError(fmt::format("{}: {}: no {} '{}'; {}", file.string(), where, attribute, value,
                                          name_hint(value, known->second)));
        }
    }
}

void require_known(const Presentation& presentation, const CellNames& names, const std::filesystem::path& file) {
    for (const Figure& figure : presentation.figures) {
        const std::string where = fmt::format("figure '{}'", figure.title);
        require_known(figure.where, names, file, where);
        require_known(figure.relative_to, names, file, where);
    }
    for (const Originals& originals : presentation.originals) {
        const std::string where = fmt::format("originals '{}'", originals.title);
        require_known(originals.where, names, file, where);
        for (const OriginalRow& row : originals.rows) require_known(row.of, names, file, where);
    }
    for (const Claim& claim : presentation.claims) {
        const std::string where = fmt::format("claim '{}'", claim.claim);
        for (const Selector* selector : {&claim.quantity.where, &claim.quantity.first, &claim.quantity.second})
            require_known(*selector, names, file, where);
    }
}

bool asks_for(const Presentation& presentation, std::string_view measure) {
    const auto has = [&](const std::string& text) { return text.find(measure) != std::string::npos; };
    return std::ranges::any_of(presentation.claims, [&](const Claim& claim) { return has(claim.quantity.measure); }) ||
           std::ranges::any_of(presentation.originals, [&](const Originals& one) { return has(one.measure); }) ||
           std::ranges::any_of(presentation.figures, [&](const Figure& figure) {
               return has(figure.y) || std::ranges::any_of(figure.columns, has);
           });
}

Measurements run_comparison(const Reproduction& reproduction, LoadedScenes& scenes, const RunOptions& options,
                            bool quick) {
    Experiment experiment = parse_experiment(reproduction.table, reproduction.file);
    experiment.name = reproduction.name;
    Measurements measurements;
    for (LeftOutScene& scene : leave_out_absent_scenes(experiment, scenes))
        measurements.left_out.push_back(std::move(scene.kept));
    require_effects_in_scenes(experiment, scenes);
    if (quick) make_quick(experiment);
    RunOptions recorded = options;
    recorded.experiment_text = reproduction.text;
    const RunResults results = run_experiment(experiment, scenes, recorded);
    measurements.started = results.started, measurements.seconds = results.seconds;
    measurements.renderer = results.gl_renderer, measurements.cpu = results.system.cpu;
    measurements.interrupted = results.interrupted;
    measurements.cells = cells_of(results);
    measurements.pictures = results.pictures, measurements.failures = results.failures;
    if (!results.interrupted) {
        add_counted_measures(
            experiment, scenes, options.backend,
            [&](std::string_view measure) { return asks_for(reproduction.presentation, measure); }, measurements.cells);
    }
    return measurements;
}

Measurements run_generation_experiment(const Reproduction& reproduction, const SceneFinder& finder,
                                       const RunOptions& options, bool quick) {
    GenerationExperiment experiment = parse_generation(reproduction.table, reproduction.file);
    if (quick) make_quick(experiment);
    const GenerationResults results = run_generation(experiment, finder, options);
    Measurements measurements;
    measurements.started = results.started, measurements.seconds = results.seconds;
    measurements.renderer = results.gl_renderer, measurements.cpu = results.system.cpu;
    measurements.interrupted = results.interrupted;
    measurements.cells = cells_of(results), measurements.failures = results.failures;
    if (!results.interrupted) write_generation_files(results, options.output);
    return measurements;
}

}  // namespace

std::vector<std::string> Reproduction::sources() const {
    std::vector<std::string> places;
    const std::regex separator("; ");
    const auto add = [&](const std::string& list) {
        const std::sregex_token_iterator parts(list.begin(), list.end(), separator, -1), none;
        for (auto part = parts; part != none; ++part) {
            const std::string place = part->str();
            if (!place.empty() && std::ranges::find(places, place) == places.end()) places.push_back(place);
        }
    };
    for (const Drawing& drawing : drawings) add(drawing.source);
    for (const Figure& figure : presentation.figures) add(figure.source);
    for (const Originals& originals : presentation.originals) add(originals.source);
    for (const Claim& claim : presentation.claims) add(claim.source);
    return places;
}

std::vector<std::string> reproduction_names() {
    std::vector<std::string> names;
    std::istringstream list{std::string(embedded::reproductions::find("order.txt"))};
    for (std::string name; std::getline(list, name);) {
        if (!name.empty()) names.push_back(name);
    }
    return names;
}

Reproduction load_reproduction(const std::string& name_or_path) {
    Reproduction reproduction;
    const std::vector<std::string> names = reproduction_names();
    const std::filesystem::path path(name_or_path);
    if (std::ranges::find(names, name_or_path) != names.end()) {
        reproduction.file = name_or_path + ".toml";
        reproduction.text = embedded::reproductions::find(reproduction.file.string());
    } else if (path.extension() == ".toml") {
        reproduction.file = path;
        reproduction.text = read_config_text(path);
    } else {
        throw ConfigError(
            fmt::format("nothing to reproduce is called '{}'; {}", name_or_path, name_hint(name_or_path, names)));
    }
    reproduction.table = parse_config(reproduction.text, name_or_path);
    reproduction.name = path.stem().string();
    if (is_drawing_file(reproduction.table)) {
        reproduction.drawings = parse_drawings(reproduction.table, reproduction.file);
        ConfigReader reader(reproduction.table, reproduction.file.string());
        reproduction.title = reader.required_text("title"), reproduction.question = reader.required_text("question");
        return reproduction;
    }
    reproduction.presentation = parse_presentation(reproduction.table, reproduction.file);
    switch (kind_of(reproduction.table, reproduction.file)) {
        case ExperimentKind::comparison: {
            const Experiment experiment = parse_experiment(reproduction.table, reproduction.file);
            reproduction.title = experiment.title, reproduction.question = experiment.question;
            require_known(reproduction.presentation, names_of(experiment), reproduction.file);
            break;
        }
        case ExperimentKind::generation: {
            const GenerationExperiment experiment = parse_generation(reproduction.table, reproduction.file);
            reproduction.title = experiment.title, reproduction.question = experiment.question;
            require_known(reproduction.presentation, names_of(experiment), reproduction.file);
            break;
        }
        case ExperimentKind::convergence:
            throw ConfigError(
                fmt::format("{}: experiments of kind 'convergence' compare the path tracer with itself; "
                            "run them with 'plumbline run'",
                            reproduction.file.string()));
    }
    return reproduction;
}

DiskUse disk_use(const Reproduction& reproduction, LoadedScenes& scenes, bool write_frames, bool quick) {
    // Walks keep nothing but a table.
    if (!reproduction.drawings.empty() || kind_of(reproduction.table, reproduction.file) != ExperimentKind::comparison)
        return {};
    Experiment experiment = parse_experiment(reproduction.table, reproduction.file);
    if (quick) make_quick(experiment);
    return disk_use(experiment, scenes, write_frames);
}

Measurements run_reproduction(const Reproduction& reproduction, LoadedScenes& scenes, const RunOptions& options,
                              bool quick) {
    Measurements measurements;
    if (reproduction.drawings.empty()) {
        const bool is_generation = kind_of(reproduction.table, reproduction.file) == ExperimentKind::generation;
        measurements = is_generation ? run_generation_experiment(reproduction, scenes.finder(), options, quick)
                                     : run_comparison(reproduction, scenes, options, quick);
    }
    measurements.experiment = reproduction.name, measurements.command = options.command;
    measurements.quick = quick;
    measurements.program = fmt::format("{} ({})", build_facts().version, build_facts().git_describe);
    return measurements;
}

}  // namespace plumb

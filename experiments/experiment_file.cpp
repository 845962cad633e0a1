#include "experiments/experiment_file.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/config_values.h"
#include "experiments/ladder.h"
#include "experiments/loaded_scenes.h"
#include "scenes/scene.h"
#include "scenes/scene_error.h"

namespace plumb {
namespace {

// Planes that both sides can deliver and that have a difference worth measuring. Positions in the list mean nothing.
const std::vector<std::string> comparable_planes = {
    "ao",       "direct",       "indirect",      "indirect.1",    "indirect.2", "indirect.3",
    "emission", "total",        "irradiance",    "depth",         "normal",     "albedo",
    "motion",   "layer2.depth", "layer2.normal", "layer2.albedo", "reflection"};

Quantities read_quantities(ConfigReader& reader) {
    Quantities quantities;
    quantities.bounces = reader.integer("bounces", quantities.bounces, 1, most_diffuse_bounces);
    read_falloff(reader, "ao_falloff", quantities.ao_falloff);
    read_falloff(reader, "indirect_falloff", quantities.indirect_falloff);
    return quantities;
}

ExperimentMeasures read_measures(ConfigReader& reader) {
    ExperimentMeasures measures;
    const std::string flip = reader.text("flip", to_string(measures.flip));
    const auto found = std::ranges::find(flip_range_names(), flip);
    if (found == flip_range_names().end())
        reader.fail("flip", fmt::format("no range '{}'; {}", flip, name_hint(flip, flip_range_names())));
    measures.flip = static_cast<FlipRange>(found - flip_range_names().begin());
    measures.pixels_per_degree = reader.number("pixels_per_degree", measures.pixels_per_degree, 1.0, 1e4);
    reader.finish();
    return measures;
}

ExperimentPath read_path(ConfigReader& reader) {
    ExperimentPath path;
    path.path = reader.required_text("path");
    path.start = reader.number("start", path.start, 0.0, 1e6);
    path.frames = reader.integer("frames", path.frames, 2, 1 << 20);
    path.frames_per_second = reader.number("frames_per_second", path.frames_per_second, 1e-3, 1e4);
    reader.finish();
    return path;
}

ExperimentScene read_scene(ConfigReader& reader, const ExperimentScene& defaults) {
    ExperimentScene scene = defaults;
    scene.scene = reader.required_text("scene");
    scene.optional = reader.boolean("optional", false);
    scene.views = reader.texts("views", {});
    for (ConfigReader& path : reader.tables("paths")) scene.paths.push_back(read_path(path));
    scene.ao_radius = static_cast<float>(reader.number("ao_radius", defaults.ao_radius, 1e-6, no_limit));
    scene.indirect_radius =
        static_cast<float>(reader.number("indirect_radius", defaults.indirect_radius, 1e-6, no_limit));
    scene.minimum_separation =
        static_cast<float>(reader.number("minimum_separation", defaults.minimum_separation, 0.0, 1e6));
    if (const ConfigValue* overrides = reader.value("method")) {
        scene.method_overrides = *overrides;
        const ConfigReader is_table(*overrides, reader.source(), "scenes.method");
    }
    reader.finish();
    return scene;
}

// Of quantities; what scenes say of themselves comes before it.
ExperimentScene read_scene_defaults(ConfigReader& quantities) {
    ExperimentScene defaults;
    defaults.ao_radius = static_cast<float>(quantities.number("ao_radius", defaults.ao_radius, 1e-6, no_limit));
    defaults.indirect_radius =
        static_cast<float>(quantities.number("indirect_radius", defaults.indirect_radius, 1e-6, no_limit));
    defaults.minimum_separation =
        static_cast<float>(quantities.number("minimum_separation", defaults.minimum_separation, 0.0, 1e6));
    quantities.finish();
    return defaults;
}

void read_reference(ConfigReader& reader, Experiment& experiment) {
    ConfigReader reference = reader.table("reference");
    experiment.reference.samples = reference.integer("samples", experiment.reference.samples, 2, 1 << 24);
    experiment.reference.path_samples = reference.integer(
        "path_samples", std::min(experiment.reference.samples, experiment.reference.path_samples), 2, 1 << 24);
    for (const auto& [key, samples] : {std::pair{"samples", experiment.reference.samples},
                                       std::pair{"path_samples", experiment.reference.path_samples}}) {
        if (samples % 2 != 0) reference.fail(key, "must be even, because the reference keeps two halves");
    }
    experiment.reference.target_error = reference.number("target_error", experiment.reference.target_error, 0.0, 1.0);
    experiment.reference.seed = static_cast<std::uint64_t>(
        reference.integer("seed", static_cast<int>(experiment.reference.seed), 0, std::numeric_limits<int>::max()));
    experiment.reference.antialias = reference.boolean("antialias", experiment.reference.antialias);
    experiment.reference.most_noise = reference.number("most_noise", experiment.reference.most_noise, 1e-6, 1e6);
    reference.finish();
}

// Rows are told apart by what is listed.
void refuse_twice(ConfigReader& reader, const char* key, const std::vector<int>& values) {
    std::set<int> seen;
    for (const int value : values) {
        if (!seen.insert(value).second) reader.fail(key, fmt::format("holds {} twice; remove one", value));
    }
}

void read_timing(ConfigReader& reader, Experiment& experiment) {
    ConfigReader timing = reader.table("timing");
    experiment.timing.warm_up = timing.integer("warm_up", experiment.timing.warm_up, 0, 1000);
    experiment.timing.repetitions = timing.integer("repetitions", experiment.timing.repetitions, 1, 100000);
    timing.finish();

    experiment.seeds = reader.integer("seeds", experiment.seeds, 1, 256);
    experiment.path_tracer_samples = reader.integers("path_tracer_samples", experiment.path_tracer_samples, 2, 1 << 20);
    for (const int samples : experiment.path_tracer_samples) {
        if (samples % 2 != 0)
            reader.fail("path_tracer_samples", fmt::format("holds {}, but must hold even numbers", samples));
    }
    refuse_twice(reader, "path_tracer_samples", experiment.path_tracer_samples);
}

void read_oracle(ConfigReader& reader, Experiment& experiment) {
    experiment.oracle_layers = reader.integers("oracle", {}, 0, 16);
    refuse_twice(reader, "oracle", experiment.oracle_layers);
    experiment.oracle_bounces = reader.integers("oracle_bounces", {}, 1, most_diffuse_bounces);
    refuse_twice(reader, "oracle_bounces", experiment.oracle_bounces);
    if (experiment.oracle_bounces.empty()) return;
    if (std::ranges::none_of(experiment.planes, has_light_of_bounces)) {
        reader.fail("oracle_bounces",
                    fmt::format("no plane of {} has light of bounces; compare indirect, irradiance, reflection or "
                                "total, or remove it",
                                fmt::join(experiment.planes, ", ")));
    }
    for (const int bounces : experiment.oracle_bounces) {
        if (bounces >= experiment.quantities.bounces) {
            reader.fail("oracle_bounces",
                        fmt::format("holds {}, but must hold fewer than the truth has, which are {}; take fewer, or "
                                    "raise 'bounces' in [quantities]",
                                    bounces, experiment.quantities.bounces));
        }
    }
}

// One value of a swept parameter, as a name shows it.
std::string sweep_text(const ConfigValue& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value.value)) return fmt::format("{}", *whole);
    if (const auto* number = std::get_if<double>(&value.value)) return fmt::format("{:g}", *number);
    return "";
}

// The methods that `sweep` makes of a method's table.
void add_sweep(const ConfigReader& reader, const ConfigValue& table, const std::vector<std::string>& planes,
               MethodList& known, MethodSelection& selection) {
    const auto fail = [&](int line, std::string_view message) {
        throw ConfigError(fmt::format("{}:{}: methods.sweep: {}", reader.source(), line, message));
    };
    ConfigValue plain = table;
    auto& members = std::get<ConfigMembers>(plain.value);
    const auto place = std::ranges::find(members, "sweep", &ConfigMember::key);
    const ConfigValue sweep = place->value;
    members.erase(place);
    const auto* swept = std::get_if<ConfigMembers>(&sweep.value);
    if (!swept || swept->size() != 1)
        fail(sweep.line, "must be a table with one parameter, such as { \"ao.samples\" = [6, 20, 50] }");
    const std::string& parameter = swept->front().key;
    const auto* values = std::get_if<ConfigArray>(&swept->front().value.value);
    if (!values || values->size() < 2)
        fail(sweep.line, fmt::format("'{}' must be an array of two values or more", parameter));
    for (const ParameterSetting& setting : parameter_settings(plain)) {
        if (setting.name == parameter)
            fail(setting.line, fmt::format("'{}' is set beside it as well; remove one of them", parameter));
    }
    MethodList made;
    for (const ConfigValue& value : *values) {
        const std::string text = sweep_text(value);
        if (text.empty()) fail(value.line, fmt::format("'{}' must hold numbers, not {}", parameter, value.type_name()));
        ConfigValue one = plain;
        std::get<ConfigMembers>(one.value).push_back({parameter, value});
        Method method = read_method(one, reader.source(), known);
        const std::string curve = method.name;
        method.name = fmt::format("{}, {} = {}", curve, parameter, text);
        require_layers(method, reader.source(), table.line, &planes);
        selection.sweep_points[method.name] = {curve, parameter, std::stod(text)};
        made.push_back(std::move(method));
    }
    std::vector<ParameterSetting> settings = parameter_settings(plain);
    settings.push_back({parameter, sweep.line});
    for (const ParameterSetting& setting : settings) {
        std::size_t idle = 0;
        for (const Method& method : made) {
            const std::string reason = reason_without_effect(method, setting.name, &planes);
            idle += reason.empty() ? 0 : 1;
            if (reason.empty() || (setting.name != parameter && idle < made.size())) continue;
            throw without_effect(reader.source(), setting, method.name, reason);
        }
        for (const Method& method : made) selection.settings.push_back({method.name, setting.name, setting.line});
    }
    known.insert(known.end(), made.begin(), made.end());
    selection.methods.insert(selection.methods.end(), made.begin(), made.end());
}

// Throws ConfigError for two that differ, but in nothing that the planes show: all their rows would be the same.
void require_methods_apart(const ConfigReader& reader, const MethodList& methods,
                           const std::vector<std::string>& planes) {
    for (std::size_t i = 0; i < methods.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            std::vector<std::string> idle;
            bool apart = false;
            for (const MethodDifference& difference : diff_methods(methods[j], methods[i])) {
                std::string reason = reason_without_effect(methods[j], difference.parameter, &planes);
                apart = reason.empty() || reason_without_effect(methods[i], difference.parameter, &planes).empty();
                if (apart) break;
                idle.push_back(fmt::format("{}: {}", difference.parameter, reason));
            }
            if (apart || idle.empty()) continue;
            reader.fail("methods", fmt::format("'{}' and '{}' differ in nothing that the planes show ({}); remove one",
                                               methods[j].name, methods[i].name, fmt::join(idle, "; ")));
        }
    }
}

}  // namespace

MethodSelection read_methods(ConfigReader& reader, const std::vector<std::string>& planes, const MethodFiles& kept) {
    const ConfigValue* tables = reader.value("methods");
    if (!tables) reader.fail("", "'methods' is missing: name at least one method");
    const auto* array = std::get_if<ConfigArray>(&tables->value);
    if (!array || array->empty()) reader.fail("methods", "must be an array with at least one method");

    MethodList known = builtin_methods();
    MethodFileReader files(reader, planes, kept);
    MethodSelection selection;
    MethodList& methods = selection.methods;
    for (const ConfigValue& entry : *array) {
        files.add_base(entry, known);
        const auto* members = std::get_if<ConfigMembers>(&entry.value);
        if (members && std::ranges::find(*members, "sweep", &ConfigMember::key) != members->end()) {
            add_sweep(reader, entry, planes, known, selection);
            continue;
        }
        Method method;
        const auto* name = std::get_if<std::string>(&entry.value);
        if (name && MethodFileReader::is_file(*name)) {
            method = files.load(*name);
            known.push_back(method);
        } else if (name) {
            const Method* found = find_method(known, *name);
            if (!found) {
                std::vector<std::string> names;
                for (const Method& candidate : known) names.push_back(candidate.name);
                reader.fail("methods", fmt::format("no method '{}'; {}", *name, name_hint(*name, names)));
            }
            method = *found;
        } else {
            method = parse_method(entry, reader.source(), known, &planes);
            known.push_back(method);
            for (const ParameterSetting& setting : parameter_settings(entry))
                selection.settings.push_back({method.name, setting.name, setting.line});
        }
        methods.push_back(std::move(method));
    }
    std::set<std::string> names;
    for (const Method& method : methods) {
        if (!names.insert(method.name).second)
            reader.fail("methods", fmt::format("two methods are called '{}'", method.name));
    }
    require_methods_apart(reader, methods, planes);
    selection.files = files.files();
    return selection;
}

ExperimentKind kind_of(const ConfigValue& table, const std::filesystem::path& file) {
    ConfigReader reader(table, file.string());
    const std::string kind = reader.text("kind", "comparison");
    if (kind == "comparison") return ExperimentKind::comparison;
    if (kind == "convergence") return ExperimentKind::convergence;
    if (kind == "generation") return ExperimentKind::generation;
    reader.fail("kind",
                fmt::format("no kind '{}'{}", kind, name_hint(kind, {"comparison", "convergence", "generation"})));
}

Experiment parse_experiment(const ConfigValue& table, const std::filesystem::path& file, const MethodFiles& kept) {
    ConfigReader reader(table, file.string());
    reader.text("kind", "comparison");
    Experiment experiment;
    experiment.file = file;
    experiment.name = reader.text("name", file.stem().string());
    experiment.title = reader.text("title", experiment.name);
    experiment.question = reader.text("question", "");

    experiment.planes = reader.texts("planes", experiment.planes);
    if (experiment.planes.empty()) reader.fail("planes", "must name at least one plane");
    for (const std::string& plane : experiment.planes) {
        if (std::ranges::find(comparable_planes, plane) == comparable_planes.end()) {
            reader.fail("planes", fmt::format("unknown plane '{}'; {}", plane, name_hint(plane, comparable_planes)));
        }
    }
    read_resolution(reader, experiment.width, experiment.height);

    ConfigReader quantities = reader.table("quantities");
    experiment.quantities = read_quantities(quantities);
    const ExperimentScene defaults = read_scene_defaults(quantities);
    read_reference(reader, experiment);
    ConfigReader measures = reader.table("measures");
    experiment.measures = read_measures(measures);
    read_timing(reader, experiment);

    for (ConfigReader& scene : reader.tables("scenes")) experiment.scenes.push_back(read_scene(scene, defaults));
    if (experiment.scenes.empty()) reader.fail("", "'scenes' is missing: write at least one [[scenes]] table");
    std::set<std::string> names;
    for (const ExperimentScene& scene : experiment.scenes) {
        if (!names.insert(scene.scene).second) reader.fail("scenes", fmt::format("'{}' is there twice", scene.scene));
    }
    read_oracle(reader, experiment);
    MethodSelection selection = read_methods(reader, experiment.planes, kept);
    experiment.methods = std::move(selection.methods);
    experiment.sweep_points = std::move(selection.sweep_points);
    experiment.method_settings = std::move(selection.settings);
    experiment.method_files = std::move(selection.files);
    for (const ExperimentScene& scene : experiment.scenes) {
        require_effective_overrides(experiment.methods, scene.method_overrides, reader.source(), &experiment.planes);
    }
    auto& presentation = std::get<ConfigMembers>(experiment.presentation.value);
    for (const char* key : {"figures", "originals", "claims", "ladders"}) {
        if (const ConfigValue* tables = reader.value(key)) presentation.push_back({key, *tables});
    }
    // What `plumbline check` holds the results against; a run only measures them.
    for (const char* key : {"thresholds", "calibration", "must_fail"}) reader.value(key);
    experiment.baseline = reader.text("baseline", experiment.methods.front().name);
    if (!find_method(experiment.methods, experiment.baseline)) {
        std::vector<std::string> methods;
        for (const Method& method : experiment.methods) methods.push_back(method.name);
        reader.fail("baseline",
                    fmt::format("no method '{}'; {}", experiment.baseline, name_hint(experiment.baseline, methods)));
    }
    reader.finish();
    read_ladders(experiment);  // throws for what climb() could not use
    return experiment;
}

Experiment load_experiment(const std::filesystem::path& file) { return parse_experiment(read_config(file), file); }

std::vector<LeftOutScene> leave_out_absent_scenes(Experiment& experiment, LoadedScenes& scenes) {
    std::vector<LeftOutScene> left_out;
    const auto leave_out = [&](const std::string& scene, const char* message, const std::string& kept) {
        const std::filesystem::path path = scene;
        left_out.push_back({fmt::format("{}: {}", scene, message),
                            fmt::format("{}: {}", path.is_absolute() ? path.filename().string() : scene, kept)});
        return true;
    };
    std::erase_if(experiment.scenes, [&](const ExperimentScene& scene) {
        if (!scene.optional) return false;
        try {
            scenes.load(scene.scene);
            return false;
        } catch (const MissingSceneFile& error) {
            return leave_out(scene.scene, error.what(), error.without_folders());
        } catch (const SceneError& error) {
            return leave_out(scene.scene, error.what(),
                             "it cannot be loaded; 'plumbline scenes' with its name and --scenes-dir says why");
        }
    });
    if (experiment.scenes.empty()) {
        std::vector<std::string> messages;
        messages.reserve(left_out.size());
        for (const LeftOutScene& scene : left_out) messages.push_back(scene.message);
        throw SceneError(fmt::format("{}: all of its scenes are optional, and none is here: {}",
                                     experiment.file.string(), fmt::join(messages, "; ")));
    }
    return left_out;
}

void require_effects_in_scenes(const Experiment& experiment, LoadedScenes& scenes) {
    const std::string source = experiment.file.string();
    std::vector<MethodSetting> idle = experiment.method_settings;  // as far as the scenes have been seen
    std::map<std::pair<std::string, std::string>, std::string> reasons;
    bool all_seen = true;
    for (const ExperimentScene& entry : experiment.scenes) {
        const bool overrides = !std::get<ConfigMembers>(entry.method_overrides.value).empty();
        if (idle.empty() && !overrides) continue;
        const Scene* scene = nullptr;
        try {
            scene = &scenes.load(entry.scene);
        } catch (const SceneError&) {
            all_seen = false;  // told when it is rendered
            continue;
        }
        require_effective_overrides(experiment.methods, entry.method_overrides, source, &experiment.planes, scene);
        std::erase_if(idle, [&](const MethodSetting& setting) {
            const Method method = method_in_scene(*find_method(experiment.methods, setting.method), entry, source);
            std::string& reason = reasons[{setting.method, setting.parameter}];
            reason = reason_without_effect(method, setting.parameter, &experiment.planes, scene);
            return reason.empty();
        });
    }
    if (!all_seen || idle.empty()) return;
    const MethodSetting& first = idle.front();
    throw ConfigError(fmt::format("{}:{}: {}: has no effect in method '{}' in any of the scenes, because {}; remove it",
                                  source, first.line, first.parameter, first.method,
                                  reasons.at({first.method, first.parameter})));
}

void make_small(Experiment& experiment) {
    experiment.width = std::max(8, experiment.width / 4);
    experiment.height = std::max(8, experiment.height / 4);
    experiment.reference.samples = std::min(experiment.reference.samples, 64);
    experiment.reference.path_samples = std::min(experiment.reference.path_samples, 16);
    experiment.reference.target_error = 0.0;
    experiment.timing.repetitions = std::min(experiment.timing.repetitions, 3);
    experiment.seeds = std::min(experiment.seeds, 2);
    std::erase_if(experiment.path_tracer_samples, [](int samples) { return samples > 4; });
}

void make_quick(Experiment& experiment) {
    make_small(experiment);
    for (ExperimentScene& scene : experiment.scenes) {
        if (scene.views.size() > 1) scene.views.resize(1);
        if (scene.paths.size() > 1) scene.paths.resize(1);
        for (ExperimentPath& path : scene.paths) path.frames = std::min(path.frames, 3);
    }
    experiment.quick = true;
}

bool has_light_of_bounces(const std::string& plane) {
    return plane == "indirect" || plane == "irradiance" || plane == "reflection" || plane == "total";
}

std::vector<std::string> views_of(const ExperimentScene& entry, const Scene& scene) {
    std::vector<std::string> views = entry.views;
    if (views.empty()) {
        for (const Camera& camera : scene.cameras) views.push_back(camera.name);
    }
    return views;
}

Quantities quantities_of(const Experiment& experiment, const ExperimentScene& entry, const std::string& plane) {
    Quantities quantities = experiment.quantities;
    quantities.planes = {plane};
    quantities.ao_radius = entry.ao_radius;
    return quantities;
}

Method method_in_scene(const Method& method, const ExperimentScene& scene, const std::string& source) {
    Method result = method;
    // A method that means a fraction of the frustum keeps its own.
    if (result.gbuffer.layers > 1 && result.gbuffer.separation_unit == SeparationUnit::metres)
        result.gbuffer.minimum_separation = scene.minimum_separation;
    if (result.radiosity.enabled) result.radiosity.radius = scene.indirect_radius;
    override_method(result, scene.method_overrides, source);
    return result;
}

}  // namespace plumb

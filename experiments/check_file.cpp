#include "experiments/check_file.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

namespace plumb {
namespace {

// Moves the members that are called one of `keys` out of `table`.
ConfigValue take_members(ConfigValue& table, const std::vector<std::string>& keys) {
    ConfigMembers taken, left;
    for (ConfigMember& member : std::get<ConfigMembers>(table.value)) {
        const bool is_one = std::ranges::find(keys, member.key) != keys.end();
        (is_one ? taken : left).push_back(std::move(member));
    }
    table.value = std::move(left);
    return {std::move(taken), table.line};
}

// The names that rows of the experiment can have in `method`; the oracle's are the runner's business.
bool is_row_of_experiment(const Experiment& experiment, const std::string& pattern) {
    if (pattern.starts_with("oracle")) return !experiment.oracle_layers.empty() || !experiment.oracle_bounces.empty();
    if (pattern.starts_with("path tracer")) return !experiment.path_tracer_samples.empty();
    return std::ranges::any_of(experiment.methods,
                               [&](const Method& method) { return matches_pattern(pattern, method.name); });
}

void require_rows(const CheckFile& check, const std::string& source) {
    std::vector<std::string> scenes, methods;
    for (const ExperimentScene& scene : check.experiment.scenes) scenes.push_back(scene.scene);
    for (const Method& method : check.experiment.methods) methods.push_back(method.name);
    const std::vector<std::string>& planes = check.experiment.planes;
    for (const Threshold& threshold : check.set.thresholds) {
        const auto fail = [&](std::string_view key, const std::string& value, const std::vector<std::string>& names) {
            throw ConfigError(fmt::format("{}:{}: threshold '{}': {} '{}' is nothing that the experiment has; {}",
                                          source, threshold.line, threshold.name, key, value, name_hint(value, names)));
        };
        const auto matches = [](const std::string& pattern) {
            return [&pattern](const std::string& name) { return matches_pattern(pattern, name); };
        };
        const RowPattern& rows = threshold.rows;
        if (std::ranges::none_of(scenes, matches(rows.scene))) fail("scene", rows.scene, scenes);
        if (std::ranges::none_of(planes, matches(rows.plane))) fail("plane", rows.plane, planes);
        if (!is_row_of_experiment(check.experiment, rows.method)) fail("method", rows.method, methods);
        if (threshold.relative_to.empty()) continue;
        if (threshold.relative_to.find('*') != std::string::npos) fail("relative_to", threshold.relative_to, methods);
        if (!is_row_of_experiment(check.experiment, threshold.relative_to))
            fail("relative_to", threshold.relative_to, methods);
    }
}

// A scene's own parameters come after a method's.
void require_broken_in_scenes(const ConfigReader& reader, const MustFail& must_fail, const ConfigValue& parameters,
                              const CheckFile& check) {
    const Threshold& threshold = *check.find_threshold(must_fail.threshold);
    for (const ExperimentScene& scene : check.experiment.scenes) {
        if (!matches_pattern(threshold.rows.scene, scene.scene)) continue;
        const Method in_scene = method_in_scene(must_fail.method, scene, reader.source());
        Method broken = in_scene;
        override_method(broken, parameters, reader.source());
        if (method_hash(broken) == method_hash(in_scene)) continue;
        reader.fail(
            "",
            fmt::format("scene '{}' sets the same parameter, which mends the method there ({} = {} instead of "
                        "{}); break another one",
                        scene.scene, diff_methods(broken, in_scene).front().parameter,
                        diff_methods(broken, in_scene).front().second, diff_methods(broken, in_scene).front().first));
    }
}

MustFail read_must_fail(ConfigReader& reader, const CheckFile& check) {
    MustFail must_fail;
    must_fail.name = reader.required_text("name");
    must_fail.threshold = reader.required_text("threshold");
    if (!check.find_threshold(must_fail.threshold)) {
        std::vector<std::string> names;
        for (const Threshold& threshold : check.set.thresholds) names.push_back(threshold.name);
        reader.fail("threshold", fmt::format("no threshold is called '{}'; {}", must_fail.threshold,
                                             name_hint(must_fail.threshold, names)));
    }
    const ConfigValue* method = reader.value("method");
    if (!method || !std::holds_alternative<ConfigMembers>(method->value)) {
        reader.fail("method",
                    "write it as a table: the method that is broken, and how, such as { base = \"two_layers\", "
                    "ao.intensity = 0.3 }");
    }
    MethodList known = builtin_methods();
    for (const Method& own : check.experiment.methods) {
        std::erase_if(known, [&](const Method& other) { return other.name == own.name; });
        known.push_back(own);
    }
    ConfigValue named = *method;
    ConfigReader table(named, reader.source(), "must_fail.method");
    table.required_text("base");
    if (table.has("name")) table.fail("name", "is that of the [[must_fail]] table; remove it");
    ConfigValue parameters = named;
    take_members(parameters, {"base"});
    if (std::get<ConfigMembers>(parameters.value).empty()) table.fail("", "breaks nothing: set at least one parameter");
    std::get<ConfigMembers>(named.value).push_back({"name", {must_fail.name, named.line}});
    // Broken where the threshold looks, and nowhere else.
    std::vector<std::string> planes = check.experiment.planes;
    std::erase_if(planes, [&](const std::string& plane) {
        return !matches_pattern(check.find_threshold(must_fail.threshold)->rows.plane, plane);
    });
    must_fail.method = parse_method(named, reader.source(), known, &planes);
    require_broken_in_scenes(table, must_fail, parameters, check);
    reader.finish();
    return must_fail;
}

}  // namespace

const Threshold* CheckFile::find_threshold(std::string_view name) const {
    const auto found = std::ranges::find(set.thresholds, name, &Threshold::name);
    return found == set.thresholds.end() ? nullptr : &*found;
}

CheckFile load_check_file(const std::filesystem::path& file) {
    ConfigValue experiment = read_config(file);
    if (kind_of(experiment, file) != ExperimentKind::comparison) {
        throw ConfigError(fmt::format("'{}': only experiments of kind \"comparison\" can be checked", file.string()));
    }
    const ConfigValue own = take_members(experiment, {"thresholds", "calibration", "must_fail"});
    CheckFile check;
    check.experiment = parse_experiment(experiment, file);

    ConfigReader reader(own, file.string());
    const ConfigValue* thresholds = reader.value("thresholds");
    const auto* beside = thresholds ? std::get_if<std::string>(&thresholds->value) : nullptr;
    if (beside) {
        check.thresholds_file = file.parent_path() / *beside;
        const ConfigValue table = read_config(check.thresholds_file);
        ConfigReader beside_reader(table, check.thresholds_file.string());
        check.set = read_thresholds(beside_reader);
        beside_reader.finish();
    } else {
        check.set = read_thresholds(reader);
    }
    const std::string source = beside ? check.thresholds_file.string() : file.string();
    if (check.set.thresholds.empty()) {
        throw ConfigError(
            fmt::format("'{}': no thresholds: write at least one [[thresholds]] table, or name a file of "
                        "them: thresholds = \"FILE.toml\"",
                        source));
    }
    require_rows(check, source);

    std::set<std::string> names;
    for (ConfigReader& table : reader.tables("must_fail")) {
        check.must_fail.push_back(read_must_fail(table, check));
        const std::string& name = check.must_fail.back().name;
        if (!names.insert(name).second || find_method(check.experiment.methods, name))
            table.fail("name", fmt::format("'{}' is the name of another method", name));
    }
    if (check.must_fail.empty()) {
        throw ConfigError(
            fmt::format("'{}': nothing proves that this gate can fail: write a [[must_fail]] table with a "
                        "method that is broken on purpose",
                        file.string()));
    }
    reader.finish();
    return check;
}

std::vector<std::string> without_limit(const CheckFile& check) {
    std::vector<std::string> names;
    for (const Threshold& threshold : check.set.thresholds) {
        if (!threshold.limit) names.push_back(threshold.name);
    }
    return names;
}

}  // namespace plumb

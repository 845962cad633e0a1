#include "experiments/thresholds.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "metrics/comparison.h"
#include "metrics/gbuffer_fidelity.h"
#include "metrics/regions.h"

namespace plumb {
namespace {

constexpr double largest = std::numeric_limits<double>::max();

constexpr std::array kind_names = {"error", "benefit", "flicker", "cost"};
constexpr std::array over_names = {"worst", "mean"};
const std::vector<std::string> flicker_measures = {"flicker", "method_warping", "temporal_variance"};

template <class Enumeration, std::size_t count>
Enumeration read_choice(ConfigReader& reader, const char* key, const std::array<const char*, count>& names,
                        std::string fallback) {
    const std::string text = reader.text(key, std::move(fallback));
    const auto found = std::ranges::find(names, text);
    if (found == names.end()) {
        const std::vector<std::string> candidates(names.begin(), names.end());
        reader.fail(key, fmt::format("unknown value '{}'; {}", text, name_hint(text, candidates)));
    }
    return static_cast<Enumeration>(found - names.begin());
}

void read_limit(ConfigReader& reader, Threshold& threshold) {
    if (reader.has("fail_above") == reader.has("fail_below")) {
        reader.fail("", fmt::format("'{}' needs either fail_above or fail_below: a number, or \"calibrate\" for what "
                                    "'plumbline check --calibrate' is to set",
                                    threshold.name));
    }
    threshold.fails_above = reader.has("fail_above");
    const std::string key(threshold.limit_key());
    const ConfigValue* value = reader.value(key);
    const auto* text = std::get_if<std::string>(&value->value);
    if (text && *text != "calibrate") reader.fail(key, "must be a number or \"calibrate\"");
    if (!text) threshold.limit = reader.number(key, 0.0, -largest, largest);
}

void read_calibrated(ConfigReader& reader, Threshold& threshold) {
    if (!reader.has("calibrated")) return;
    ConfigReader table = reader.table("calibrated");
    CalibratedValue value;
    value.runs = table.integer("runs", 0, 1, std::numeric_limits<int>::max());
    value.mean = table.number("mean", 0.0, -largest, largest);
    value.spread = table.number("spread", 0.0, 0.0, largest);
    value.least = table.number("least", value.mean, -largest, largest);
    value.greatest = table.number("greatest", value.mean, -largest, largest);
    table.finish();
    threshold.calibrated = value;
}

void read_measure(ConfigReader& reader, Threshold& threshold) {
    std::vector<std::string> known = flicker_measures;
    if (threshold.kind == ThresholdKind::error) known.clear();
    if (threshold.kind != ThresholdKind::flicker) {
        known.insert(known.end(), measure_names().begin(), measure_names().end());
        known.insert(known.end(), fidelity_names().begin(), fidelity_names().end());
    }
    const bool of_flicker = threshold.kind == ThresholdKind::flicker;
    threshold.measure = reader.text("measure", of_flicker ? "flicker" : "rmse");
    if (std::ranges::find(known, threshold.measure) == known.end()) {
        reader.fail("measure", fmt::format("unknown measure '{}' of kind \"{}\"; {}", threshold.measure,
                                           to_string(threshold.kind), name_hint(threshold.measure, known)));
    }
    threshold.region = reader.text("region", "");
    const auto& regions = region_names();
    if (!threshold.region.empty() && std::ranges::find(regions, threshold.region) == regions.end())
        reader.fail("region",
                    fmt::format("no region '{}'; {}", threshold.region, name_hint(threshold.region, regions)));
    if (!threshold.region.empty() && std::ranges::find(fidelity_names(), threshold.measure) != fidelity_names().end())
        reader.fail("region", fmt::format("{} is only measured over whole views", threshold.measure));
    if (!threshold.region.empty() && threshold.measure.starts_with("ms_ssim"))
        reader.fail("region", "the coarser scales of ms_ssim have no regions; take another measure, such as ssim");
}

Threshold read_threshold(ConfigReader& reader) {
    Threshold threshold;
    threshold.line = reader.line();
    threshold.name = reader.required_text("name");
    if (threshold.name.empty()) reader.fail("name", "must not be empty");
    reader.required_text("kind");
    threshold.kind = read_choice<ThresholdKind>(reader, "kind", kind_names, "error");
    const bool is_ratio = threshold.kind == ThresholdKind::benefit || threshold.kind == ThresholdKind::cost;

    threshold.rows.scene = reader.text("scene", threshold.rows.scene);
    threshold.rows.plane = reader.required_text("plane");
    threshold.rows.method = reader.required_text("method");
    if (threshold.kind != ThresholdKind::cost) {
        threshold.rows.truth = reader.text("truth", threshold.rows.truth);
        read_measure(reader, threshold);
    }
    const bool of_paths = threshold.kind == ThresholdKind::flicker ||
                          std::ranges::find(flicker_measures, threshold.measure) != flicker_measures.end();
    // An error over a camera path is asked for by naming the path.
    if (of_paths || (threshold.kind != ThresholdKind::cost && reader.has("path"))) {
        threshold.rows.path = reader.text("path", "*");
        threshold.rows.view = "";
    } else {
        threshold.rows.view = reader.text("view", threshold.rows.view);
        threshold.rows.path = "";
    }
    if (threshold.kind == ThresholdKind::benefit) threshold.relative_to = reader.required_text("relative_to");
    if (threshold.kind == ThresholdKind::cost) threshold.relative_to = reader.text("relative_to", "");
    threshold.over = read_choice<OverRows>(reader, "over", over_names, is_ratio ? "mean" : "worst");
    read_limit(reader, threshold);
    threshold.reason = reader.required_text("reason");
    if (threshold.reason.find_first_not_of(" \t\n") == std::string::npos) {
        reader.fail("reason", "must say why this limit is there: who meets the failure has nothing else to go by");
    }
    read_calibrated(reader, threshold);
    reader.finish();
    return threshold;
}

// A TOML basic string.
std::string toml_text(std::string_view text) {
    std::string result = "\"";
    for (const char letter : text) {
        const auto byte = static_cast<unsigned char>(letter);
        if (letter == '"' || letter == '\\') {
            result.append("\\").append(1, letter);
        } else if (byte < 0x20 || byte == 0x7F) {
            result.append(fmt::format("\\u{:04X}", static_cast<unsigned>(byte)));
        } else {
            result.append(1, letter);
        }
    }
    return result.append("\"");
}

std::string print_threshold(const Threshold& threshold) {
    std::string text = "\n[[thresholds]]\n";
    const auto add = [&](std::string_view key, std::string_view value) {
        text.append(fmt::format("{} = {}\n", key, toml_text(value)));
    };
    const Threshold defaults;
    add("name", threshold.name);
    add("kind", to_string(threshold.kind));
    if (threshold.rows.scene != defaults.rows.scene) add("scene", threshold.rows.scene);
    if (!threshold.rows.path.empty()) add("path", threshold.rows.path);
    if (!threshold.rows.view.empty() && threshold.rows.view != defaults.rows.view) add("view", threshold.rows.view);
    add("plane", threshold.rows.plane);
    if (threshold.rows.truth != defaults.rows.truth) add("truth", threshold.rows.truth);
    add("method", threshold.rows.method);
    if (!threshold.relative_to.empty()) add("relative_to", threshold.relative_to);
    if (!threshold.measure.empty()) add("measure", threshold.measure);
    if (!threshold.region.empty()) add("region", threshold.region);
    add("over", to_string(threshold.over));
    text.append(fmt::format("{} = {}\n", threshold.limit_key(),
                            threshold.limit ? fmt::format("{:.6g}", *threshold.limit) : "\"calibrate\""));
    add("reason", threshold.reason);
    if (threshold.calibrated) {
        const CalibratedValue& value = *threshold.calibrated;
        text.append(fmt::format(
            "calibrated = {{ runs = {}, mean = {:.9g}, spread = {:.3g}, least = {:.9g}, greatest = {:.9g} }}\n",
            value.runs, value.mean, value.spread, value.least, value.greatest));
    }
    return text;
}

}  // namespace

std::string_view to_string(ThresholdKind kind) { return kind_names.at(static_cast<std::size_t>(kind)); }
std::string_view to_string(OverRows over) { return over_names.at(static_cast<std::size_t>(over)); }

bool matches_pattern(std::string_view pattern, std::string_view text) {
    // On a mismatch the last star takes one letter more.
    std::size_t in_pattern = 0, in_text = 0, star = std::string_view::npos, resume = 0;
    while (in_text < text.size()) {
        if (in_pattern < pattern.size() && pattern[in_pattern] == '*') {
            star = in_pattern++, resume = in_text;
        } else if (in_pattern < pattern.size() && pattern[in_pattern] == text[in_text]) {
            ++in_pattern, ++in_text;
        } else if (star != std::string_view::npos) {
            in_pattern = star + 1, in_text = ++resume;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', in_pattern) == std::string_view::npos;
}

ThresholdSet read_thresholds(ConfigReader& reader) {
    ThresholdSet set;
    std::set<std::string> names;
    for (ConfigReader& table : reader.tables("thresholds")) {
        set.thresholds.push_back(read_threshold(table));
        if (!names.insert(set.thresholds.back().name).second)
            table.fail("name", fmt::format("two thresholds are called '{}'", set.thresholds.back().name));
    }
    if (reader.has("calibration")) {
        ConfigReader table = reader.table("calibration");
        CalibrationNote note;
        note.machines = table.texts("machines", {});
        note.date = table.text("date", "");
        note.workload = table.integer("workload", 0, 0, std::numeric_limits<int>::max());
        table.finish();
        set.calibration = note;
    }
    return set;
}

std::string print_thresholds(const ThresholdSet& set) {
    std::string text =
        "# Limits that `plumbline check` holds this experiment to. `plumbline check --calibrate` writes the limits "
        "and\n"
        "# `calibrated` anew from repeated runs and keeps all else; experiments/calibration.h states its rule.\n";
    if (set.calibration) {
        std::vector<std::string> machines;
        for (const std::string& machine : set.calibration->machines) machines.push_back(toml_text(machine));
        text.append(fmt::format("\n[calibration]\ndate = {}\nmachines = [{}]\nworkload = {}\n",
                                toml_text(set.calibration->date), fmt::join(machines, ", "),
                                set.calibration->workload));
    }
    for (const Threshold& threshold : set.thresholds) text.append(print_threshold(threshold));
    return text;
}

}  // namespace plumb

#include "experiments/claims.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/result_table.h"

namespace plumb {
namespace {

MeanSummary summarise(const std::vector<double>& values, QuantityKind kind) {
    if (kind != QuantityKind::ratio) return summarise_mean(values);
    const RatioSummary ratios = summarise_ratios(values);
    MeanSummary summary;
    summary.mean = ratios.mean, summary.lower = ratios.lower, summary.upper = ratios.upper;
    summary.count = ratios.count;
    return summary;
}

bool matches(const Cell& cell, const MeasuredQuantity& quantity, const Selector& half) {
    return quantity.where.matches(cell) && half.matches(cell);
}

// Whether two cells differ in nothing but what the selectors of the two halves name. A method is told apart by its
// name, its curve and its parameter, so that naming one of them names all.
bool are_partners(const Cell& first, const Cell& second, const MeasuredQuantity& quantity) {
    const auto is_named = [&](std::string_view attribute) {
        return quantity.first.names(attribute) || quantity.second.names(attribute);
    };
    const bool names_method = is_named("method") || is_named("curve") || is_named("parameter");
    return std::ranges::all_of(cell_attributes(), [&](const std::string& attribute) {
        const bool is_of_method = attribute == "method" || attribute == "curve" || attribute == "parameter";
        if (is_of_method ? names_method : is_named(attribute)) return true;
        return attribute_of(first, attribute) == attribute_of(second, attribute);
    });
}

MeasuredCase measured_case(const Cell& cell, double value) {
    return {cell.scene, cell.place, cell.plane, cell.truth, cell.method, value};
}

void add_pairs(const std::vector<Cell>& cells, const MeasuredQuantity& quantity, Measured& measured) {
    for (const Cell& cell : cells) {
        if (!matches(cell, quantity, quantity.first)) continue;
        const Cell* partner = nullptr;
        for (const Cell& candidate : cells) {
            if (&candidate == &cell || !matches(candidate, quantity, quantity.second)) continue;
            if (!are_partners(cell, candidate, quantity)) continue;
            if (partner) {
                throw ConfigError(fmt::format(
                    "'{}' on {} / {}: both '{}' and '{}' could be what '{}' is set against; name more in the second "
                    "selector",
                    quantity.measure, cell.scene, cell.place, partner->method, candidate.method, cell.method));
            }
            partner = &candidate;
        }
        const double first = measure_of(cell, quantity.measure);
        const double second = partner ? measure_of(*partner, quantity.measure) : std::nan("");
        const bool is_ratio = quantity.kind == QuantityKind::ratio;
        const double value = is_ratio ? first / second : first - second;
        if (std::isfinite(value) && !(is_ratio && !(first > 0.0 && second > 0.0))) {
            measured.cases.push_back(measured_case(cell, value));
        } else {
            ++measured.missing;
        }
    }
}

void add_values(const std::vector<Cell>& cells, const MeasuredQuantity& quantity, Measured& measured) {
    for (const Cell& cell : cells) {
        if (!matches(cell, quantity, quantity.first)) continue;
        const double value = measure_of(cell, quantity.measure);
        if (std::isfinite(value)) {
            measured.cases.push_back(measured_case(cell, value));
        } else {
            ++measured.missing;
        }
    }
}

void add_slopes(const std::vector<Cell>& cells, const MeasuredQuantity& quantity, Measured& measured) {
    struct Curve {
        const Cell* cell = nullptr;
        std::vector<double> x, y;
    };
    std::map<std::tuple<std::string, std::string, std::string, std::string, std::string>, Curve> curves;
    for (const Cell& cell : cells) {
        if (cell.curve.empty() || !matches(cell, quantity, quantity.first)) continue;
        Curve& curve = curves[{cell.scene, cell.place, cell.plane, cell.truth, cell.curve}];
        curve.cell = &cell;
        const double value = measure_of(cell, quantity.measure);
        if (!(value > 0.0) || !(cell.parameter > 0.0)) continue;
        curve.x.push_back(std::log(cell.parameter)), curve.y.push_back(std::log(value));
    }
    for (const auto& entry : curves) {
        const Curve& curve = entry.second;
        // Two points always lie on a line, and say nothing of whether it is one.
        if (curve.x.size() < 3) {
            ++measured.missing;
        } else {
            MeasuredCase slope = measured_case(*curve.cell, fit_line(curve.x, curve.y).slope);
            slope.method = curve.cell->curve;
            measured.cases.push_back(slope);
        }
    }
}

bool is_inside(const Claim& claim, double lower, double upper) {
    return (!claim.above || lower > *claim.above) && (!claim.below || upper < *claim.below);
}
bool is_outside(const Claim& claim, double lower, double upper) {
    return (claim.above && upper < *claim.above) || (claim.below && lower > *claim.below);
}

std::ptrdiff_t cases_inside(const Claim& claim, const Measured& measured) {
    return std::ranges::count_if(measured.cases,
                                 [&](const MeasuredCase& entry) { return is_inside(claim, entry.value, entry.value); });
}

std::string mean_text(const Claim& claim, const MeanSummary& summary) {
    return fmt::format("{}{}{}", short_number(summary.mean), claim.unit,
                       claim.quantity.kind == QuantityKind::ratio ? " times" : "");
}

std::string scenes_text(const Claim& claim, const Measured& measured, const std::vector<std::string>& scenes) {
    std::vector<std::string> texts;
    texts.reserve(scenes.size());
    for (const std::string& scene : scenes)
        texts.push_back(fmt::format("{} ({})", scene, scene_text(claim, measured, scene)));
    return fmt::format("{}", fmt::join(texts, ", "));
}

// Of a claim whose cases or scenes answer differently.
std::string dependence(const Claim& claim, const Measured& measured) {
    std::vector<std::string> inside, elsewhere;
    for (const std::string& scene : measured.scenes()) {
        const double mean = measured.of_scene(scene).mean;
        (is_inside(claim, mean, mean) ? inside : elsewhere).push_back(scene);
    }
    if (!inside.empty() && !elsewhere.empty()) {
        return fmt::format("on the scene: holds in {}; not in {}", scenes_text(claim, measured, inside),
                           scenes_text(claim, measured, elsewhere));
    }
    return fmt::format("on the view: holds in {} of {}", cases_inside(claim, measured), measured.cases.size());
}

// Of a claim whose interval includes a bound, though its cases agree.
std::string indecision(const Claim& claim, const Measured& measured) {
    return fmt::format("it holds in {} of {} cases, which are too few, or differ too widely, for their mean to be told",
                       cases_inside(claim, measured) == 0 ? "none" : "all", measured.cases.size());
}

}  // namespace

MeanSummary Measured::of_scene(const std::string& scene) const { return summarise(values_of(scene), kind); }

std::vector<double> Measured::values_of(const std::string& scene) const {
    std::vector<double> values;
    for (const MeasuredCase& entry : cases) {
        if (entry.scene == scene) values.push_back(entry.value);
    }
    return values;
}

std::vector<std::string> Measured::scenes() const {
    std::vector<std::string> names;
    for (const MeasuredCase& entry : cases) {
        if (std::ranges::find(names, entry.scene) == names.end()) names.push_back(entry.scene);
    }
    return names;
}

Measured measure_quantity(const std::vector<Cell>& cells, const MeasuredQuantity& quantity) {
    Measured measured;
    measured.kind = quantity.kind;
    switch (quantity.kind) {
        case QuantityKind::value:
            add_values(cells, quantity, measured);
            break;
        case QuantityKind::slope:
            add_slopes(cells, quantity, measured);
            break;
        case QuantityKind::ratio:
        case QuantityKind::difference:
            add_pairs(cells, quantity, measured);
            break;
    }
    std::vector<double> values;
    values.reserve(measured.cases.size());
    for (const MeasuredCase& entry : measured.cases) values.push_back(entry.value);
    measured.summary = summarise(values, measured.kind);
    return measured;
}

std::string to_string(ClaimVerdict verdict) {
    switch (verdict) {
        case ClaimVerdict::holds:
            return "holds";
        case ClaimVerdict::fails:
            return "fails";
        case ClaimVerdict::depends:
            return "depends";
        case ClaimVerdict::undecided:
            return "not decided";
        case ClaimVerdict::untested:
            break;
    }
    return "untested";
}

ClaimResult judge_claim(const Claim& claim, const Measured& measured) {
    ClaimResult result;
    result.claim = claim, result.measured = measured;
    const MeanSummary& all = measured.summary;
    if (all.count < 2) {
        result.reason = all.count == 1 ? "only one case was measured, which gives no interval" : "nothing was measured";
        return result;
    }
    bool some_scene_holds = false, some_scene_fails = false;
    for (const std::string& scene : measured.scenes()) {
        const MeanSummary part = measured.of_scene(scene);
        if (part.count < 2) continue;
        some_scene_holds |= is_inside(claim, part.lower, part.upper);
        some_scene_fails |= is_outside(claim, part.lower, part.upper);
    }
    if (is_inside(claim, all.lower, all.upper) && !some_scene_fails) {
        result.verdict = ClaimVerdict::holds;
    } else if (is_outside(claim, all.lower, all.upper) && !some_scene_holds) {
        result.verdict = ClaimVerdict::fails;
    } else if (const auto count = cases_inside(claim, measured); count == 0 || count == std::ssize(measured.cases)) {
        result.verdict = ClaimVerdict::undecided;
        result.reason = indecision(claim, measured);
    } else {
        result.verdict = ClaimVerdict::depends;
        result.reason = dependence(claim, measured);
    }
    return result;
}

ClaimResult judge_claim(const Claim& claim, const std::vector<Cell>& cells) {
    return judge_claim(claim, measure_quantity(cells, claim.quantity));
}

std::string range_text(const Claim& claim) {
    std::vector<std::string> parts;
    if (claim.above) parts.push_back(fmt::format("above {}{}", short_number(*claim.above), claim.unit));
    if (claim.below) parts.push_back(fmt::format("below {}{}", short_number(*claim.below), claim.unit));
    return fmt::format("{}", fmt::join(parts, " and "));
}

std::string scene_text(const Claim& claim, const Measured& measured, const std::string& scene) {
    const std::vector<double> values = measured.values_of(scene);
    const MeanSummary summary = measured.of_scene(scene);
    if (values.size() != 2) return measured_text(claim, summary);
    return fmt::format("{} (2 cases: {}, {})", mean_text(claim, summary), short_number(values[0]),
                       short_number(values[1]));
}

std::string measured_text(const Claim& claim, const MeanSummary& summary) {
    if (summary.count == 0) return "-";
    std::string text = mean_text(claim, summary);
    if (std::isfinite(summary.lower) && std::isfinite(summary.upper))
        text += fmt::format(" [{}, {}]", short_number(summary.lower), short_number(summary.upper));
    return text;
}

}  // namespace plumb

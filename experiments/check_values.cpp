#include "experiments/check_values.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/no_value.h"
#include "experiments/row_measurement.h"

namespace plumb {
namespace {

// What one row says: a value, or why there is none.
struct RowValue {
    std::string place;
    std::optional<double> value;
    std::string untold;
};

bool matches(const RowPattern& pattern, const ResultRow& row) {
    if (!row.is_method() && pattern.method != row.method) return false;
    if (row.path.empty() != pattern.path.empty()) return false;
    return matches_pattern(pattern.scene, row.scene) && matches_pattern(pattern.view, row.view) &&
           matches_pattern(pattern.path, row.path) && matches_pattern(pattern.plane, row.plane) &&
           (row.truth.empty() || matches_pattern(pattern.truth, row.truth)) &&
           matches_pattern(pattern.method, row.method);
}

bool is_of_stability(const std::string& measure) {
    return std::ranges::find(stability_names(), measure) != stability_names().end();
}

// Into the value of a row, or why there is none; `where` ends the sentence.
void tell_stability(const std::optional<PathStabilityResult>& stability, const ResultRow& row,
                    const std::string& measure, const std::string& where, RowValue& result) {
    const double value = stability ? stability->measure(measure) : no_value;
    if (!std::isfinite(value))
        result.untold = fmt::format("{}{} does not exist here", measure, where);
    else if (result.untold = refusal_of(*stability, measure, row.reference_samples); result.untold.empty())
        result.value = value;
}

double measure_of(const ResultRow& row, const std::string& measure) {
    if (measure == "rmse") return row.rmse();
    if (measure == "mse") return row.mse;
    const double value = measure_named(row.measures, measure);
    return std::isnan(value) ? measure_named(row.fidelity, measure) : value;
}

double measure_of(const RegionError& region, const std::string& measure) {
    if (measure == "rmse") return std::sqrt(std::max(0.0, region.mse));
    if (measure == "mse") return region.mse;
    return measure_named(region.measures, measure);
}

RowValue region_value(const ResultRow& row, const Threshold& threshold) {
    RowValue result{fmt::format("{} / {}", row.scene, row.place()), {}, {}};
    const auto found = std::ranges::find(row.regions, threshold.region, &RegionError::region);
    if (found == row.regions.end()) {
        std::vector<std::string> names;
        for (const RegionError& region : row.regions) names.push_back(region.region);
        result.untold = fmt::format("has no region '{}'; {}", threshold.region,
                                    names.empty() ? "it has none" : name_hint(threshold.region, names));
    } else if (found->pixels == 0) {
        result.untold = fmt::format("region '{}' has no pixels", threshold.region);
    } else if (is_of_stability(threshold.measure)) {
        tell_stability(found->stability, row, threshold.measure, fmt::format(" over region '{}'", threshold.region),
                       result);
    } else if (!found->measured) {
        result.untold = fmt::format("the error over region '{}' is lost in the truth's noise", threshold.region);
    } else if (const double value = measure_of(*found, threshold.measure); std::isfinite(value)) {
        result.value = value;
    } else {
        result.untold = fmt::format("{} over region '{}' does not exist here", threshold.measure, threshold.region);
    }
    return result;
}

RowValue value_of_row(const ResultRow& row, const Threshold& threshold) {
    RowValue result{fmt::format("{} / {}", row.scene, row.place()), {}, {}};
    if (!row.measured) {
        result.untold = row.refusal;
        return result;
    }
    if (!threshold.region.empty()) return region_value(row, threshold);
    if (is_of_stability(threshold.measure)) {
        tell_stability(row.stability, row, threshold.measure, "", result);
        return result;
    }
    const double value = measure_of(row, threshold.measure);
    if (std::isfinite(value)) {
        result.value = value;
    } else {
        result.untold = fmt::format("{} does not exist here", threshold.measure);
    }
    return result;
}

const ResultRow* counterpart(const std::vector<ResultRow>& rows, const ResultRow& row, const std::string& method) {
    const auto found = std::ranges::find_if(rows, [&](const ResultRow& other) {
        return other.method == method && other.scene == row.scene && other.view == row.view && other.path == row.path &&
               other.plane == row.plane && other.truth == row.truth;
    });
    return found == rows.end() ? nullptr : &*found;
}

RowValue ratio(const RowValue& numerator, const RowValue& denominator, const std::string& relative_to) {
    RowValue result{numerator.place, {}, {}};
    if (!numerator.value) {
        result.untold = numerator.untold;
    } else if (!denominator.value) {
        result.untold = fmt::format("{}: {}", relative_to, denominator.untold);
    } else if (*numerator.value <= 0.0 || *denominator.value <= 0.0) {
        result.untold = fmt::format("{} / {} is no ratio that can be limited", *numerator.value, *denominator.value);
    } else {
        result.value = *numerator.value / *denominator.value;
    }
    return result;
}

RowValue time_of_row(const ResultRow& row) {
    RowValue result{fmt::format("{} / {}", row.scene, row.place()), {}, {}};
    if (row.timing.repetitions > 0)
        result.value = row.timing.median;
    else
        result.untold = "was not timed";
    return result;
}

std::vector<RowValue> values_of_rows(const Threshold& threshold, const std::vector<ResultRow>& rows) {
    const auto value = [&](const ResultRow& row) {
        return threshold.kind == ThresholdKind::cost ? time_of_row(row) : value_of_row(row, threshold);
    };
    std::vector<RowValue> values;
    for (const ResultRow& row : rows) {
        if (!matches(threshold.rows, row)) continue;
        if (threshold.relative_to.empty()) {
            values.push_back(value(row));
            continue;
        }
        if (row.method == threshold.relative_to) continue;  // always 1; a pattern may well cover it
        const ResultRow* base = counterpart(rows, row, threshold.relative_to);
        const RowValue missing{"", {}, "has no row here"};
        values.push_back(ratio(value(row), base ? value(*base) : missing, threshold.relative_to));
    }
    return values;
}

std::vector<RowValue> values_of_costs(const Threshold& threshold, const std::vector<CostRatio>& costs) {
    std::vector<RowValue> values;
    for (const CostRatio& cost : costs) {
        if (!matches_pattern(threshold.rows.scene, cost.scene) || !matches_pattern(threshold.rows.view, cost.view) ||
            !matches_pattern(threshold.rows.plane, cost.plane) || !matches_pattern(threshold.rows.method, cost.method))
            continue;
        values.push_back({fmt::format("{} / {}", cost.scene, cost.view), cost.ratio, {}});
    }
    return values;
}

double mean_of(const std::vector<double>& values, bool geometric) {
    double sum = 0.0;
    for (const double value : values) sum += geometric ? std::log(value) : value;
    const double mean = sum / static_cast<double>(values.size());
    return geometric ? std::exp(mean) : mean;
}

// What the rows are called where the threshold looked for others.
std::string rows_there(const Threshold& threshold, const std::vector<ResultRow>& rows) {
    std::set<std::string> places, truths;
    for (const ResultRow& row : rows) {
        if (!matches_pattern(threshold.rows.scene, row.scene)) continue;
        places.insert(row.path.empty() ? fmt::format("view {}", row.view) : fmt::format("path {}", row.path));
        if (!row.truth.empty()) truths.insert(row.truth);
    }
    if (places.empty()) return fmt::format("scene '{}' has no rows at all", threshold.rows.scene);
    return fmt::format("there are {}{}{}", fmt::join(places, ", "), truths.empty() ? "" : "; truths ",
                       fmt::join(truths, ", "));
}

}  // namespace

ThresholdValue value_of(const Threshold& threshold, const std::vector<ResultRow>& rows,
                        const std::vector<CostRatio>& costs) {
    const bool of_workload = threshold.kind == ThresholdKind::cost && threshold.relative_to.empty();
    const std::vector<RowValue> found =
        of_workload ? values_of_costs(threshold, costs) : values_of_rows(threshold, rows);

    ThresholdValue result;
    if (found.empty()) {
        const std::string place = threshold.rows.path.empty() ? fmt::format("view '{}'", threshold.rows.view)
                                                              : fmt::format("path '{}'", threshold.rows.path);
        result.unmatched = fmt::format("no row has scene '{}', {}, plane '{}', truth '{}' and method '{}'; {}",
                                       threshold.rows.scene, place, threshold.rows.plane, threshold.rows.truth,
                                       threshold.rows.method, rows_there(threshold, rows));
        return result;
    }
    std::vector<double> values;
    for (const RowValue& row : found) {
        if (!row.value) {
            result.untold.push_back(fmt::format("{}: {}", row.place, row.untold));
            continue;
        }
        values.push_back(*row.value);
        const bool worse =
            !result.value || (threshold.fails_above ? *row.value > *result.value : *row.value < *result.value);
        if (worse) result.value = *row.value, result.place = row.place;
    }
    result.rows = static_cast<int>(values.size());
    if (values.size() > 1 && threshold.over == OverRows::mean) {
        const bool geometric = threshold.kind == ThresholdKind::benefit || threshold.kind == ThresholdKind::cost;
        result.value = mean_of(values, geometric);
        result.place = fmt::format("mean of {}", values.size());
    }
    return result;
}

}  // namespace plumb

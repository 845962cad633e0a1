#include "experiments/calibration.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace plumb {

double calibration_floor(const Threshold& threshold) {
    return threshold.kind == ThresholdKind::cost || !threshold.rows.path.empty() ? 0.10 : 0.02;
}

CalibratedValue pool(const std::vector<double>& values, const std::optional<CalibratedValue>& before) {
    CalibratedValue result;
    result.runs = static_cast<int>(values.size());
    double sum = 0.0, squares = 0.0;
    for (const double value : values) sum += value;
    result.mean = sum / result.runs;
    for (const double value : values) squares += (value - result.mean) * (value - result.mean);
    result.least = *std::ranges::min_element(values), result.greatest = *std::ranges::max_element(values);
    if (before) {
        const double apart = result.mean - before->mean;
        const int runs = result.runs + before->runs;
        squares +=
            before->spread * before->spread * (before->runs - 1) + apart * apart * before->runs * result.runs / runs;
        result.mean += (before->mean - result.mean) * before->runs / runs;
        result.runs = runs;
        result.least = std::min(result.least, before->least);
        result.greatest = std::max(result.greatest, before->greatest);
    }
    result.spread = result.runs > 1 ? std::sqrt(squares / (result.runs - 1)) : 0.0;
    return result;
}

double pooled_relative_spread(const std::vector<Threshold>& thresholds, ThresholdKind kind) {
    double squares = 0.0;
    int freedom = 0;
    for (const Threshold& threshold : thresholds) {
        if (threshold.kind != kind || !threshold.calibrated || threshold.calibrated->mean == 0.0) continue;
        const double relative = threshold.calibrated->spread / threshold.calibrated->mean;
        squares += relative * relative * (threshold.calibrated->runs - 1);
        freedom += threshold.calibrated->runs - 1;
    }
    return freedom > 0 ? std::sqrt(squares / freedom) : 0.0;
}

double round_outwards(double limit, bool upwards, int digits) {
    if (limit == 0.0) return 0.0;
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(limit))) - (digits - 1));
    // A limit that has those digits already, but for the last bits of the division, stays.
    const double units = limit / unit, nearest = std::round(units);
    if (std::abs(units - nearest) < 1e-9 * std::abs(nearest)) return nearest * unit;
    return (upwards ? std::ceil(units) : std::floor(units)) * unit;
}

double calibrated_limit(const Threshold& threshold, double pooled_spread) {
    const CalibratedValue& value = threshold.calibrated.value();
    const double size = std::abs(value.mean);
    if (size == 0.0) {
        throw ConfigError(
            fmt::format("threshold '{}': its value is zero in every run, from which no limit follows; write "
                        "{} = NUMBER by hand into a [[thresholds]] table that is not calibrated, or remove it",
                        threshold.name, threshold.limit_key()));
    }
    const double noise = 4.0 * std::max(value.spread, pooled_spread * size);
    const double worst = threshold.fails_above ? value.greatest - value.mean : value.mean - value.least;
    const double reach = std::max({noise, calibration_floor(threshold) * size, worst});
    return round_outwards(threshold.fails_above ? value.mean + reach : value.mean - reach, threshold.fails_above);
}

std::vector<Threshold> calibrate(std::vector<Threshold> thresholds, const std::vector<std::vector<double>>& values,
                                 bool add) {
    for (std::size_t i = 0; i < thresholds.size(); ++i) {
        thresholds[i].calibrated = pool(values[i], add ? thresholds[i].calibrated : std::nullopt);
    }
    for (Threshold& threshold : thresholds)
        threshold.limit = calibrated_limit(threshold, pooled_relative_spread(thresholds, threshold.kind));
    return thresholds;
}

}  // namespace plumb

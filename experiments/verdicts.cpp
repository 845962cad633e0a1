#include "experiments/verdicts.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/no_value.h"

namespace plumb {
namespace {

std::string value_name(const Threshold& threshold) {
    const std::string of = threshold.region.empty() ? "" : fmt::format(" over {}", threshold.region);
    switch (threshold.kind) {
        case ThresholdKind::benefit:
            return fmt::format("{}{} as ratio to {}", threshold.measure, of, threshold.relative_to);
        case ThresholdKind::cost:
            return fmt::format("time as ratio to {}",
                               threshold.relative_to.empty() ? "the calibrating workload" : threshold.relative_to);
        case ThresholdKind::error:
        case ThresholdKind::flicker:
            break;
    }
    return threshold.measure + of;
}

}  // namespace

std::string_view to_string(VerdictStatus status) {
    constexpr std::array names = {"kept", "BREACHED", "UNTOLD", "NO ROW"};
    return names.at(static_cast<std::size_t>(status));
}

double Verdict::margin() const {
    if (!value.value || !threshold.limit) return no_value;
    const double inside = threshold.fails_above ? *threshold.limit - *value.value : *value.value - *threshold.limit;
    return inside / std::abs(*threshold.limit);
}

double Verdict::change() const {
    if (!value.value || !threshold.calibrated || threshold.calibrated->mean == 0.0) return no_value;
    return (*value.value - threshold.calibrated->mean) / std::abs(threshold.calibrated->mean);
}

bool Verdict::moved() const {
    if (!value.value || !threshold.calibrated) return false;
    constexpr double kept_digits = 1e-8;  // of the nine that are written
    const CalibratedValue& before = *threshold.calibrated;
    return std::abs(*value.value - before.mean) > 4.0 * before.spread + kept_digits * std::abs(before.mean);
}

Verdict judge(const Threshold& threshold, ThresholdValue value) {
    Verdict verdict{threshold, std::move(value), VerdictStatus::kept, ""};
    const ThresholdValue& found = verdict.value;
    if (!found.unmatched.empty()) {
        verdict.status = VerdictStatus::unmatched;
        verdict.message = found.unmatched;
        return verdict;
    }
    const double limit = threshold.limit.value();
    const std::string untold = fmt::format("{}", fmt::join(found.untold, "; "));
    if (!found.value) {
        verdict.status = VerdictStatus::untold;
        verdict.message = untold;
        return verdict;
    }
    // Written so that NaN breaks a limit.
    const bool kept = threshold.fails_above ? *found.value <= limit : *found.value >= limit;
    const std::string what = fmt::format("{} = {:.6g} ({})", value_name(threshold), *found.value, found.place);
    if (!kept) {
        verdict.status = VerdictStatus::breached;
        verdict.message =
            fmt::format("{} is {} the limit {:.6g}", what, threshold.fails_above ? "above" : "below", limit);
    } else if (!found.untold.empty()) {
        verdict.status = VerdictStatus::untold;
        verdict.message =
            fmt::format("{} keeps the limit {:.6g}, but of other rows nothing can be told: {}", what, limit, untold);
    } else {
        verdict.message = fmt::format("{} keeps the limit {:.6g}", what, limit);
    }
    return verdict;
}

std::vector<Verdict> judge_all(const std::vector<Threshold>& thresholds, const std::vector<ResultRow>& rows,
                               const std::vector<CostRatio>& costs) {
    std::vector<Verdict> verdicts;
    verdicts.reserve(thresholds.size());
    for (const Threshold& threshold : thresholds)
        verdicts.push_back(judge(threshold, value_of(threshold, rows, costs)));
    return verdicts;
}

std::string describe_movement(const std::vector<Verdict>& verdicts) {
    int better = 0, worse = 0, told = 0;
    for (const Verdict& verdict : verdicts) {
        told += verdict.value.value && verdict.threshold.calibrated ? 1 : 0;
        if (!verdict.moved()) continue;
        const bool is_worse = (verdict.change() > 0.0) == verdict.threshold.fails_above;
        (is_worse ? worse : better) += 1;
    }
    if (better + worse == 0) return "";
    std::string text = fmt::format(
        "{} of {} values moved by more than their noise since the calibration: {} for the "
        "worse, {} for the better.",
        better + worse, told, worse, better);
    // Five in one direction by chance: once in sixteen.
    if (better + worse >= 5 && (better == 0 || worse == 0)) {
        text.append(
            " All in one direction: rather another driver, a changed truth or a change to what all methods share "
            "than many changes at once.");
    }
    return text;
}

}  // namespace plumb

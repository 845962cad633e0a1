// What a threshold says of a run's value.
#pragma once

#include <string>
#include <vector>

#include "experiments/check_values.h"
#include "experiments/thresholds.h"

namespace plumb {

enum class VerdictStatus {
    kept,
    breached,
    untold,     // a row that it covers cannot be told, because the truth is too noisy: no pass
    unmatched,  // no row is what it asks for: the file is wrong, and no pass either
};
std::string_view to_string(VerdictStatus status);

struct Verdict {
    Threshold threshold;
    ThresholdValue value;
    VerdictStatus status = VerdictStatus::kept;
    std::string message;  // one line with the values; of a kept one as well

    // How far the value is inside its limit as a share of the limit; below zero: outside. NaN where there is no value.
    double margin() const;
    // The value's change since the calibration, as a share. NaN where it was never calibrated, or against zero.
    double change() const;
    // Whether it changed by more than its noise: four times the calibrated spread, or, where repeated runs were the
    // same to the last bit, the digits that the thresholds file keeps.
    bool moved() const;
};

// The threshold must have a limit.
Verdict judge(const Threshold& threshold, ThresholdValue value);
std::vector<Verdict> judge_all(const std::vector<Threshold>& thresholds, const std::vector<ResultRow>& rows,
                               const std::vector<CostRatio>& costs);

// What the changes since the calibration say together; empty where nothing moved.
std::string describe_movement(const std::vector<Verdict>& verdicts);

}  // namespace plumb

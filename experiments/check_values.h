// The one value that a threshold limits, out of a run's rows.
//
//   error     a measure of the rows: against the truth, of views, or of whole camera paths where `path` is given.
//             rmse and mse are free of the truth's noise where that is possible, as in every table
//   benefit   the measure as a ratio to that of another method on the same view or path: below 1 it helps
//   flicker   how unsteady the error is over camera paths (metrics/path_stability.h)
//   cost      the time as a ratio to the calibrating workload (cost_round.h), or to another method's time, which the
//             run measured in turn with it
//
// Several rows become one value: the worst, or the mean (geometric for the ratios benefit and cost, since ratios
// multiply; arithmetic for others). Rows of the path tracer and of oracles match only their full name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/cost_round.h"
#include "experiments/results.h"
#include "experiments/thresholds.h"

namespace plumb {

struct ThresholdValue {
    std::optional<double> value;  // none: no row has one
    int rows = 0;                 // that it is over
    std::string place;            // of the worst: "clutter / shelf"; else how many
    // Rows that match and of which nothing can be told (the truth is too noisy, the measure does not exist), with why.
    std::vector<std::string> untold;
    std::string unmatched;  // where no row matches: what there is instead
};

ThresholdValue value_of(const Threshold& threshold, const std::vector<ResultRow>& rows,
                        const std::vector<CostRatio>& costs);

}  // namespace plumb

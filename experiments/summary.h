// A run's results as a reader of a terminal or a page wants them: a table, and sentences.
#pragma once

#include <string>
#include <vector>

#include "experiments/results.h"

namespace plumb {

// One line per row: scene, view, plane, method, RMSE with its 95 % interval, PSNR, SSIM, milliseconds with quartiles.
std::string print_results_table(const std::vector<ResultRow>& rows);

// For every plane and truth, and every method but the baseline: its error and its time as ratios to the baseline's,
// geometric means over views with 95 % intervals, and what follows.
std::vector<std::string> summarise(const RunResults& results);

}  // namespace plumb

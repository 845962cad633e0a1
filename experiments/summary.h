// A run's results as a reader of a terminal or a page wants them: a table, and sentences.
#pragma once

#include <string>
#include <vector>

#include "experiments/results.h"

namespace plumb {

// One line per row: scene, view or path, plane, method, RMSE with its 95 % interval, PSNR, SSIM, milliseconds with
// quartiles, and flicker where there are paths; then the data ranges, and why what is refused is.
std::string print_results_table(const std::vector<ResultRow>& rows);

// For every plane and truth, of views and of paths, and for every method but the baseline: its error, its flicker and
// its time as ratios to the baseline's, geometric means with 95 % intervals, and what follows. Then what more layers
// could bring: the oracle with each number of layers against the one before.
std::vector<std::string> summarise(const RunResults& results);

}  // namespace plumb

// What accuracy costs: the error of each method over its milliseconds, with the path tracer's own curve in the same
// axes, as a figure and as rows of equal time and equal error.
#pragma once

#include <string>
#include <vector>

#include "experiments/no_value.h"
#include "experiments/results.h"

namespace plumb {

// One method on one scene, plane and truth, averaged over its views and paths (geometric means).
struct EqualRow {
    std::string scene, plane, truth, method;
    int views = 0;
    double milliseconds = 0.0, rmse = 0.0;
    bool on_front = false;  // no other method is faster and more accurate
    // Of the path tracer, with as much time: its RMSE over the method's; below 1 it is the better choice. With the same
    // error: its time over the method's. Means of the views' ratios; 0 where the path tracer has no curve there.
    // Without value where there are too few views for an interval (RatioSummary::has_interval).
    double rmse_ratio = 0.0, rmse_ratio_lower = no_value, rmse_ratio_upper = no_value;
    double time_ratio = 0.0, time_ratio_lower = no_value, time_ratio_upper = no_value;
    // Views on which its curve had to be continued beyond its first or last number of samples.
    int extrapolated_at_equal_time = 0, extrapolated_at_equal_error = 0;
};

// By scene, plane and truth as the rows have them, then by method. Rows that were refused count for nothing.
std::vector<EqualRow> equal_rows(const RunResults& results);

// The rows as a table with a line on how to read it; empty where there are none.
std::string print_equal_rows(const RunResults& results);
std::string print_equal_rows_csv(const RunResults& results);

// One panel for each scene, plane and truth, both axes logarithmic: a point for each method (curves of sweeps joined),
// the Pareto front, and the path tracer's curve; as SVG. Empty where nothing was measured.
std::string print_accuracy_figure(const RunResults& results);

}  // namespace plumb

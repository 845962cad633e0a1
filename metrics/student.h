// Student's t: means of a few independent values and their 95 % intervals.
#pragma once

#include <vector>

#include "metrics/block_bootstrap.h"

namespace plumb {

// The 97.5 % quantile, for 1 degree of freedom or more.
double student_t(int degrees);

// Mean with its 95 % interval; infinite to both sides for a single value, NaN for none. Good for: what varies from seed
// to seed, or from view to view. Bad for: pixels, which are not independent.
Estimate student_mean(const std::vector<double>& values);

}  // namespace plumb

// Ratios with their intervals, as readers see them: what counts is on which side of 1 an interval ends.
#pragma once

#include <string>

#include "experiments/statistics.h"

namespace plumb {

struct RatioText {
    std::string mean, lower, upper;
};

// All with two digits behind the point, or with as many more (six at most) as it takes that no end of the interval is
// rounded to 1. The ends are empty where there is no interval to tell.
RatioText print_ratio(const RatioSummary& ratio);

}  // namespace plumb

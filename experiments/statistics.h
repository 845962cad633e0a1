// Small samples: quartiles, and the mean of ratios with its interval.
#pragma once

#include <vector>

namespace plumb {

// The value below which the fraction p (0..1) lies, linear between order statistics. `values` must not be empty.
double quantile(std::vector<double> values, double p);

struct RatioSummary {
    double mean = 1.0;                // geometric
    double lower = 1.0, upper = 1.0;  // 95 % interval of the mean; infinite to both sides for a single ratio
    int count = 0;
    int below_one = 0;
};

// Student's t interval of the mean logarithm: ratios multiply, so their logarithms average. All must be positive.
RatioSummary summarise_ratios(const std::vector<double>& ratios);

}  // namespace plumb

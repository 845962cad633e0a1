// Small samples: quartiles, means and means of ratios with their intervals, and fitted lines.
#pragma once

#include <vector>

namespace plumb {

// The value below which the fraction p (0..1) lies, linear between order statistics. `values` must not be empty.
double quantile(std::vector<double> values, double p);

// From how many values on an interval is told. That of two has a single degree of freedom, and a t of 12.7: it says
// [0.03, 112], that is, that two are too few.
constexpr int fewest_for_interval = 3;

struct RatioSummary {
    double mean = 1.0;                // geometric
    double lower = 1.0, upper = 1.0;  // 95 % interval of the mean; infinite to both sides for a single ratio
    int count = 0;
    int below_one = 0;

    bool has_interval() const { return count >= fewest_for_interval; }
};

// Student's t interval of the mean logarithm: ratios multiply, so their logarithms average. All must be positive.
RatioSummary summarise_ratios(const std::vector<double>& ratios);

struct MeanSummary {
    double mean = 0.0;
    double standard_error = 0.0;
    double lower = 0.0, upper = 0.0;  // Student's 95 % interval; infinite to both sides for a single value
    int count = 0;

    bool has_interval() const { return count >= fewest_for_interval; }
};

MeanSummary summarise_mean(const std::vector<double>& values);

// y = intercept + slope * x by least squares. There must be two different x at least.
struct LineFit {
    double slope = 0.0, intercept = 0.0;
};

LineFit fit_line(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace plumb

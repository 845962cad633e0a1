#include "experiments/statistics.h"

#include <algorithm>
#include <cmath>

#include "metrics/student.h"

namespace plumb {

double quantile(std::vector<double> values, double p) {
    std::ranges::sort(values);
    const double place = p * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return std::lerp(values[below], values[above], place - static_cast<double>(below));
}

RatioSummary summarise_ratios(const std::vector<double>& ratios) {
    RatioSummary summary;
    summary.count = static_cast<int>(ratios.size());
    if (ratios.empty()) return summary;
    std::vector<double> logarithms;
    for (const double ratio : ratios) {
        logarithms.push_back(std::log(ratio));
        summary.below_one += ratio < 1.0 ? 1 : 0;
    }
    const MeanSummary mean = summarise_mean(logarithms);
    summary.mean = std::exp(mean.mean);
    summary.lower = std::exp(mean.lower), summary.upper = std::exp(mean.upper);
    return summary;
}

MeanSummary summarise_mean(const std::vector<double>& values) {
    MeanSummary summary;
    summary.count = static_cast<int>(values.size());
    if (values.empty()) return summary;
    const Estimate mean = student_mean(values);
    summary.mean = mean.value, summary.lower = mean.lower, summary.upper = mean.upper;
    summary.standard_error =
        summary.count > 1 ? (mean.upper - mean.value) / student_t(summary.count - 1) : mean.upper - mean.value;
    return summary;
}

LineFit fit_line(const std::vector<double>& x, const std::vector<double>& y) {
    const double mean_x = summarise_mean(x).mean, mean_y = summarise_mean(y).mean;
    double covariance = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        covariance += (x[i] - mean_x) * (y[i] - mean_y);
        variance += (x[i] - mean_x) * (x[i] - mean_x);
    }
    const double slope = covariance / variance;
    return {slope, mean_y - slope * mean_x};
}

}  // namespace plumb

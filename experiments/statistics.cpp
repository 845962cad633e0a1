#include "experiments/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
    double sum = 0.0;
    for (const double value : values) sum += value;
    summary.mean = sum / summary.count;
    if (summary.count == 1) {
        summary.standard_error = std::numeric_limits<double>::infinity();
        summary.lower = -std::numeric_limits<double>::infinity();
        summary.upper = std::numeric_limits<double>::infinity();
        return summary;
    }
    double squares = 0.0;
    for (const double value : values) squares += (value - summary.mean) * (value - summary.mean);
    summary.standard_error = std::sqrt(squares / (summary.count - 1) / summary.count);
    const double half_width = student_t(summary.count - 1) * summary.standard_error;
    summary.lower = summary.mean - half_width, summary.upper = summary.mean + half_width;
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

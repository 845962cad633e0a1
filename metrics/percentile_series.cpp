#include "metrics/percentile_series.h"

#include <cmath>
#include <utility>

#include "metrics/measure_blocks.h"

namespace plumb {

void PercentileSeries::add(double percentile, std::vector<BlockSum> not_above) {
    shares_.add(std::move(not_above));
    if (!std::isnan(percentile)) percentiles_.add({{percentile, 1}});
}

Estimate PercentileSeries::mean(const QuantileCurve& magnitudes, const BootstrapSettings& settings) const {
    const Estimate over_images = percentiles_.mean(settings);
    const Estimate over_blocks = percentile_interval(over_images.value, level_, shares_.mean(settings), magnitudes);
    if (percentiles_.frames() < 2) return over_blocks;
    const auto add_up = [&](double a, double b) { return std::hypot(a - over_images.value, b - over_images.value); };
    return {over_images.value, over_images.value - add_up(over_images.lower, over_blocks.lower),
            over_images.value + add_up(over_images.upper, over_blocks.upper)};
}

}  // namespace plumb

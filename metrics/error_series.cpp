#include "metrics/error_series.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "frames/image_error.h"

namespace plumb {

ErrorSeries::ErrorSeries(SeriesOf kind, const ReferencedErrorSettings& settings)
    : settings_(settings), products_(kind == SeriesOf::frames ? 8 : 1) {}

std::optional<ReferencedError> ErrorSeries::add(const Frame& method, const Frame& reference, std::string_view plane,
                                                int reference_samples, const Image* mask) {
    const std::string name(plane), a = fmt::format("half_a.{}", plane), b = fmt::format("half_b.{}", plane);
    const bool paired = method.has(a) && method.has(b);
    const Image& test_a = method.plane(paired ? a : name);
    const BlockGrid grid(test_a.width(), test_a.height(), settings_.bootstrap.block_size);
    ErrorSums sums =
        sum_errors(test_a, method.plane(paired ? b : name), reference.plane(a), reference.plane(b), grid, mask);
    if (sums.values == 0) return std::nullopt;
    const ReferencedError error = referenced_error_of(sums, bootstrap_mean(sums.products, settings_.bootstrap),
                                                      reference_samples, settings_.noise_limit);
    least_samples_ = errors_.empty() ? reference_samples : std::min(least_samples_, reference_samples);
    errors_.push_back(error.mse);
    sums_.block_size = sums.block_size;
    sums_.plain += sums.plain, sums_.noise += sums.noise;
    sums_.values += sums.values, sums_.left_out += sums.left_out;
    products_.add(std::move(sums.products));
    return error;
}

ReferencedError ErrorSeries::error() const {
    return referenced_error_of(sums_, products_.mean(settings_.bootstrap), least_samples_, settings_.noise_limit);
}

}  // namespace plumb

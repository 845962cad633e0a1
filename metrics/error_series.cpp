#include "metrics/error_series.h"

#include <algorithm>
#include <utility>

namespace plumb {

ErrorSeries::ErrorSeries(SeriesOf kind, const ReferencedErrorSettings& settings)
    : settings_(settings), products_(longest_run(kind)) {
    relative_.fill(BlockSeries(longest_run(kind)));
}

std::optional<ReferencedError> ErrorSeries::add(const Frame& method, const Frame& reference, std::string_view plane,
                                                int reference_samples, const Image* mask) {
    const BlockGrid grid(method.width(), method.height(), settings_.bootstrap.block_size);
    ErrorSums sums = sum_errors(method, reference, plane, grid, mask);
    if (sums.values == 0) return std::nullopt;
    const ReferencedError error =
        referenced_error_of(sums, bootstrap_means(sums, settings_.bootstrap), reference_samples, settings_.noise_limit);
    add(std::move(sums), reference_samples);
    return error;
}

void ErrorSeries::add(ErrorSums sums, int reference_samples) {
    if (sums.values == 0) return;
    least_samples_ = errors_.empty() ? reference_samples : std::min(least_samples_, reference_samples);
    errors_.push_back(mean_of(sums.products));
    sums_.block_size = sums.block_size;
    sums_.plain += sums.plain, sums_.noise += sums.noise;
    sums_.values += sums.values, sums_.left_out += sums.left_out;
    products_.add(std::move(sums.products));
    for (std::size_t i = 0; i < relative_.size(); ++i) relative_[i].add(std::move(sums.relative[i]));
}

ReferencedError ErrorSeries::error() const {
    ErrorMeans means{products_.mean(settings_.bootstrap), {}};
    for (std::size_t i = 0; i < relative_.size(); ++i) means.relative_mse[i] = relative_[i].mean(settings_.bootstrap);
    return referenced_error_of(sums_, means, least_samples_, settings_.noise_limit);
}

}  // namespace plumb

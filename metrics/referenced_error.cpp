#include "metrics/referenced_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "frames/image_error.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

void require_settings(const ReferencedErrorSettings& settings) {
    if (!(settings.noise_limit > 0.0)) {
        throw ImageError(fmt::format("the noise limit must be above zero, not {}", settings.noise_limit));
    }
}

template <typename Mean>
ErrorMeans means_of(const ErrorSums& sums, const Mean& mean) {
    ErrorMeans means{mean(sums.products), {}};
    for (std::size_t i = 0; i < relative_mses.size(); ++i) means.relative_mse[i] = mean(sums.relative[i]);
    return means;
}

}  // namespace

std::string half_a_of(std::string_view plane) { return fmt::format("half_a.{}", plane); }
std::string half_b_of(std::string_view plane) { return fmt::format("half_b.{}", plane); }

bool has_halves(const Frame& frame, std::string_view plane) {
    return frame.has(half_a_of(plane)) && frame.has(half_b_of(plane));
}

std::optional<std::int64_t> ReferencedError::samples_needed() const {
    const double error = mse > 0.0 ? mse : upper;
    if (reference_samples <= 0 || !(error > 0.0)) return std::nullopt;
    const double samples = reference_samples * reference_noise_mse / (noise_limit * error);
    return 2 * static_cast<std::int64_t>(std::ceil(std::max(samples, 2.0) / 2.0));
}

ReferencedError referenced_error(const Image& test, const Image& half_a, const Image& half_b, int reference_samples,
                                 const ReferencedErrorSettings& settings) {
    return paired_referenced_error(test, test, half_a, half_b, reference_samples, settings);
}

ErrorSums sum_errors(const Image& test_a, const Image& test_b, const Image& half_a, const Image& half_b,
                     const BlockGrid& grid, const Image* mask) {
    require_same_shape(test_a, half_a, "the image and the reference's first half");
    require_same_shape(test_a, half_b, "the image and the reference's second half");
    require_same_shape(test_b, half_b, "the image's second half and the reference's");
    if (mask) require_mask_fits(*mask, test_a);
    ErrorSums sums;
    sums.block_size = grid.block_size();
    sums.products.resize(grid.count());
    for (std::vector<BlockSum>& relative : sums.relative) relative.resize(grid.count());
    for (int y = 0; y < test_a.height(); ++y) {
        for (int x = 0; x < test_a.width(); ++x) {
            if (!pixel_counts(mask, x, y)) continue;
            for (int c = 0; c < test_a.channels(); ++c) {
                const double a = double{test_a.at(x, y, c)} - half_a.at(x, y, c),
                             b = double{test_b.at(x, y, c)} - half_b.at(x, y, c);
                if (!std::isfinite(a) || !std::isfinite(b)) {
                    ++sums.left_out;
                    continue;
                }
                const std::size_t block = grid.block_of(x, y);
                const double reference = 0.5 * (double{half_a.at(x, y, c)} + half_b.at(x, y, c));
                sums.products[block].add(a * b);
                for (std::size_t i = 0; i < relative_mses.size(); ++i)
                    sums.relative[i][block].add(a * b / relative_mses[i].weight(reference));
                sums.plain += 0.25 * (a + b) * (a + b);
                sums.noise += 0.25 * (a - b) * (a - b);
                ++sums.values;
            }
        }
    }
    return sums;
}

ErrorMeans bootstrap_means(const ErrorSums& sums, const BootstrapSettings& settings) {
    return means_of(sums, [&](const std::vector<BlockSum>& blocks) { return bootstrap_mean(blocks, settings); });
}

ErrorMeans means_without_intervals(const ErrorSums& sums) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return means_of(sums, [](const std::vector<BlockSum>& blocks) { return Estimate{mean_of(blocks), none, none}; });
}

ReferencedError referenced_error_of(const ErrorSums& sums, const ErrorMeans& means, int reference_samples,
                                    double noise_limit) {
    if (sums.values == 0) {
        throw ImageError(
            fmt::format("nothing to compare: {} values are not finite, all others are masked", sums.left_out));
    }
    const auto count = static_cast<double>(sums.values);
    ReferencedError result;
    result.mse = means.mse.value, result.lower = means.mse.lower, result.upper = means.mse.upper;
    result.relative_mse = means.relative_mse;
    result.plain_mse = sums.plain / count;
    result.reference_noise_mse = sums.noise / count;
    result.noise_limit = noise_limit;
    result.reference_samples = reference_samples;
    result.block_size = sums.block_size;
    result.left_out = sums.left_out;
    if (result.reference_noise_mse == 0.0) {
        result.ratio = 0.0;
        result.trustworthy = true;
    } else {
        result.ratio =
            result.mse > 0.0 ? result.reference_noise_mse / result.mse : std::numeric_limits<double>::infinity();
        result.trustworthy = result.ratio <= noise_limit && result.lower > 0.0;
    }
    return result;
}

ReferencedError paired_referenced_error(const Image& test_a, const Image& test_b, const Image& half_a,
                                        const Image& half_b, int reference_samples,
                                        const ReferencedErrorSettings& settings) {
    require_settings(settings);
    const BlockGrid grid(test_a.width(), test_a.height(), settings.bootstrap.block_size, settings.mask);
    const ErrorSums sums = sum_errors(test_a, test_b, half_a, half_b, grid, settings.mask);
    return referenced_error_of(sums, bootstrap_means(sums, settings.bootstrap), reference_samples,
                               settings.noise_limit);
}

ErrorSums sum_errors(const Frame& method, const Frame& reference, std::string_view plane, const BlockGrid& grid,
                     const Image* mask) {
    const std::string name(plane), a = half_a_of(plane), b = half_b_of(plane);
    const bool paired = has_halves(method, plane);
    return sum_errors(method.plane(paired ? a : name), method.plane(paired ? b : name), reference.plane(a),
                      reference.plane(b), grid, mask);
}

ReferencedError referenced_error(const Frame& method, const Frame& reference, std::string_view plane,
                                 int reference_samples, const ReferencedErrorSettings& settings) {
    require_settings(settings);
    const BlockGrid grid(method.width(), method.height(), settings.bootstrap.block_size, settings.mask);
    const ErrorSums sums = sum_errors(method, reference, plane, grid, settings.mask);
    return referenced_error_of(sums, bootstrap_means(sums, settings.bootstrap), reference_samples,
                               settings.noise_limit);
}

}  // namespace plumb

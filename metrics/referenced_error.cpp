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

// The errors of one value against each half.
struct Pair {
    double a = 0, b = 0;
};

// Sums over all values that count of what error_at(x, y, channel) gives.
template <typename ErrorAt>
ReferencedError measure(const Image& like, int reference_samples, const ReferencedErrorSettings& settings,
                        const ErrorAt& error_at) {
    if (settings.mask) require_mask_fits(*settings.mask, like);
    if (!(settings.noise_limit > 0.0)) {
        throw ImageError(fmt::format("the noise limit must be above zero, not {}", settings.noise_limit));
    }
    const BlockGrid grid(like.width(), like.height(), settings.bootstrap.block_size, settings.mask);
    ReferencedError result;
    result.noise_limit = settings.noise_limit;
    result.reference_samples = reference_samples;
    result.block_size = grid.block_size();

    std::vector<BlockSum> blocks(grid.count());
    double plain = 0, noise = 0, product_sum = 0;
    std::size_t values = 0;
    for (int y = 0; y < like.height(); ++y) {
        for (int x = 0; x < like.width(); ++x) {
            if (!pixel_counts(settings.mask, x, y)) continue;
            for (int c = 0; c < like.channels(); ++c) {
                const Pair error = error_at(x, y, c);
                if (!std::isfinite(error.a) || !std::isfinite(error.b)) {
                    ++result.left_out;
                    continue;
                }
                const double product = error.a * error.b, mean = 0.5 * (error.a + error.b);
                blocks[grid.block_of(x, y)].add(product);
                product_sum += product;
                plain += mean * mean;
                noise += 0.25 * (error.a - error.b) * (error.a - error.b);
                ++values;
            }
        }
    }
    if (values == 0) {
        throw ImageError(
            fmt::format("nothing to compare in {}x{} pixels: {} values are not finite, all others are masked",
                        like.width(), like.height(), result.left_out));
    }
    const auto count = static_cast<double>(values);
    result.mse = product_sum / count;
    result.plain_mse = plain / count;
    result.reference_noise_mse = noise / count;
    const Estimate interval = bootstrap_mean(std::move(blocks), settings.bootstrap);
    result.lower = interval.lower, result.upper = interval.upper;
    if (result.reference_noise_mse == 0.0) {
        result.ratio = 0.0;
        result.trustworthy = true;
    } else {
        result.ratio =
            result.mse > 0.0 ? result.reference_noise_mse / result.mse : std::numeric_limits<double>::infinity();
        result.trustworthy = result.ratio <= settings.noise_limit && result.lower > 0.0;
    }
    return result;
}

}  // namespace

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

ReferencedError paired_referenced_error(const Image& test_a, const Image& test_b, const Image& half_a,
                                        const Image& half_b, int reference_samples,
                                        const ReferencedErrorSettings& settings) {
    require_same_shape(test_a, half_a, "the image and the reference's first half");
    require_same_shape(test_a, half_b, "the image and the reference's second half");
    require_same_shape(test_b, half_b, "the image's second half and the reference's");
    return measure(test_a, reference_samples, settings, [&](int x, int y, int c) -> Pair {
        return {double{test_a.at(x, y, c)} - half_a.at(x, y, c), double{test_b.at(x, y, c)} - half_b.at(x, y, c)};
    });
}

ReferencedError referenced_error(const Frame& method, const Frame& reference, std::string_view plane,
                                 int reference_samples, const ReferencedErrorSettings& settings) {
    const std::string name(plane);
    return referenced_error(method.plane(name), reference.plane("half_a." + name), reference.plane("half_b." + name),
                            reference_samples, settings);
}

ReferencedError paired_referenced_error(const Frame& method, const Frame& reference, std::string_view plane,
                                        int reference_samples, const ReferencedErrorSettings& settings) {
    const std::string a = fmt::format("half_a.{}", plane), b = fmt::format("half_b.{}", plane);
    return paired_referenced_error(method.plane(a), method.plane(b), reference.plane(a), reference.plane(b),
                                   reference_samples, settings);
}

}  // namespace plumb

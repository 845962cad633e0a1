#include "metrics/referenced_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "frames/image_error.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

constexpr int fewest_blocks = 64;

struct Block {
    double sum = 0;  // of (I - A)(I - B)
    std::size_t values = 0;
};

int blocks_along(int pixels, int block_size) { return (pixels + block_size - 1) / block_size; }

int fitting_block_size(const Image& image, int wanted) {
    int size = std::max(wanted, 1);
    while (size > 1 && blocks_along(image.width(), size) * blocks_along(image.height(), size) < fewest_blocks)
        size /= 2;
    return size;
}

// SplitMix64 (Steele, Lea, Flood 2014): the same numbers with every compiler and library.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    // Uniform in 0..count-1 by multiplying high (Lemire 2019); its bias of count / 2^32 is far below what 1000 draws
    // show.
    std::size_t below(std::size_t count) {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return static_cast<std::size_t>(((z ^ (z >> 31)) >> 32) * count >> 32);
    }

private:
    std::uint64_t state_;
};

std::pair<double, double> bootstrap_interval(const std::vector<Block>& blocks, int resamples, std::uint64_t seed) {
    Random random(seed);
    std::vector<double> means(static_cast<std::size_t>(resamples));
    for (double& mean : means) {
        Block total;
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            const Block& block = blocks[random.below(blocks.size())];
            total.sum += block.sum;
            total.values += block.values;
        }
        mean = total.sum / static_cast<double>(total.values);
    }
    std::ranges::sort(means);
    const auto at = [&](double p) { return means[static_cast<std::size_t>(std::lround(p * (resamples - 1)))]; };
    return {at(0.025), at(0.975)};
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
    require_same_shape(test, half_a, "the image and the reference's first half");
    require_same_shape(test, half_b, "the image and the reference's second half");
    if (settings.mask) require_mask_fits(*settings.mask, test);
    if (settings.resamples < 40 || !(settings.noise_limit > 0.0)) {
        throw ImageError(
            fmt::format("a 95 % interval needs at least 40 resamples and a noise limit above zero, not {} and {}",
                        settings.resamples, settings.noise_limit));
    }
    ReferencedError result;
    result.noise_limit = settings.noise_limit;
    result.reference_samples = reference_samples;
    result.block_size = fitting_block_size(test, settings.block_size);

    const int columns = blocks_along(test.width(), result.block_size);
    std::vector<Block> blocks(static_cast<std::size_t>(columns) *
                              static_cast<std::size_t>(blocks_along(test.height(), result.block_size)));
    double plain = 0, noise = 0, product_sum = 0;
    std::size_t values = 0;
    for (int y = 0; y < test.height(); ++y) {
        for (int x = 0; x < test.width(); ++x) {
            if (!pixel_counts(settings.mask, x, y)) continue;
            Block& block = blocks[static_cast<std::size_t>(y / result.block_size) * static_cast<std::size_t>(columns) +
                                  static_cast<std::size_t>(x / result.block_size)];
            for (int c = 0; c < test.channels(); ++c) {
                const double i = test.at(x, y, c), a = half_a.at(x, y, c), b = half_b.at(x, y, c);
                if (!std::isfinite(i) || !std::isfinite(a) || !std::isfinite(b)) {
                    ++result.left_out;
                    continue;
                }
                const double product = (i - a) * (i - b), mean = 0.5 * (a + b);
                block.sum += product;
                ++block.values;
                product_sum += product;
                plain += (i - mean) * (i - mean);
                noise += 0.25 * (a - b) * (a - b);
                ++values;
            }
        }
    }
    if (values == 0) {
        throw ImageError(
            fmt::format("nothing to compare in {}x{} pixels: {} values are not finite, all others are masked",
                        test.width(), test.height(), result.left_out));
    }
    std::erase_if(blocks, [](const Block& block) { return block.values == 0; });
    const auto count = static_cast<double>(values);
    result.mse = product_sum / count;
    result.plain_mse = plain / count;
    result.reference_noise_mse = noise / count;
    std::tie(result.lower, result.upper) = bootstrap_interval(blocks, settings.resamples, settings.seed);
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

ReferencedError referenced_error(const Frame& method, const Frame& reference, std::string_view plane,
                                 int reference_samples, const ReferencedErrorSettings& settings) {
    const std::string name(plane);
    return referenced_error(method.plane(name), reference.plane("half_a." + name), reference.plane("half_b." + name),
                            reference_samples, settings);
}

}  // namespace plumb

#include "metrics/block_bootstrap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "frames/image_error.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

constexpr int fewest_blocks = 64;
constexpr std::size_t fewest_runs = 8;
constexpr int fewest_resamples = 40;  // the 2.5 % tail then holds one

int blocks_along(int pixels, int size) { return (pixels + size - 1) / size; }

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

void require_resamples(int resamples) {
    if (resamples < fewest_resamples) {
        throw ImageError(
            fmt::format("a 95 % interval needs at least {} resamples, not {}", fewest_resamples, resamples));
    }
}

Estimate with_percentiles(double value, std::vector<double> means) {
    std::ranges::sort(means);
    const auto at = [&](double p) {
        return means[static_cast<std::size_t>(std::lround(p * static_cast<double>(means.size() - 1)))];
    };
    return {value, at(0.025), at(0.975)};
}

// How often each of `count` things was drawn in as many draws.
std::vector<double> draw_counts(Random& random, std::size_t count) {
    std::vector<double> counts(count, 0.0);
    for (std::size_t i = 0; i < count; ++i) counts[random.below(count)] += 1.0;
    return counts;
}

std::vector<std::vector<BlockSum>> in_runs(const std::vector<std::vector<BlockSum>>& frames, std::size_t length) {
    while (length > 1 && (frames.size() + length - 1) / length < fewest_runs) length /= 2;
    std::vector<std::vector<BlockSum>> runs;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (i % length == 0) runs.emplace_back(frames[i].size());
        for (std::size_t b = 0; b < frames[i].size(); ++b) {
            runs.back()[b].sum += frames[i][b].sum;
            runs.back()[b].values += frames[i][b].values;
        }
    }
    return runs;
}

}  // namespace

double mean_of(const std::vector<BlockSum>& blocks) {
    BlockSum total;
    for (const BlockSum& block : blocks) total.sum += block.sum, total.values += block.values;
    return total.values == 0 ? std::numeric_limits<double>::quiet_NaN() : total.sum / static_cast<double>(total.values);
}

Estimate Estimate::root() const {
    // Not std::max, which would make a zero of a NaN.
    const auto root_of = [](double x) { return x < 0.0 ? 0.0 : std::sqrt(x); };
    return {root_of(value), root_of(lower), root_of(upper)};
}

BlockGrid::BlockGrid(int width, int height, int largest_size, const Image* mask) : size_(std::max(largest_size, 1)) {
    if (mask) require_mask_fits(*mask, Image(width, height, 1));
    const auto occupied = [&] {
        if (!mask) return static_cast<std::ptrdiff_t>(count());
        std::vector<char> holds(count(), 0);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                if (pixel_counts(mask, x, y)) holds[block_of(x, y)] = 1;
            }
        }
        return std::ranges::count(holds, 1);
    };
    for (;; size_ /= 2) {
        columns_ = blocks_along(width, size_), rows_ = blocks_along(height, size_);
        if (size_ == 1 || occupied() >= fewest_blocks) return;
    }
}

Estimate bootstrap_mean(std::vector<BlockSum> blocks, const BootstrapSettings& settings) {
    require_resamples(settings.resamples);
    std::erase_if(blocks, [](const BlockSum& block) { return block.values == 0; });
    const double value = mean_of(blocks);
    if (blocks.empty()) return {value, value, value};
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (blocks.size() == 1) return {value, -infinity, infinity};
    Random random(settings.seed);
    std::vector<double> means(static_cast<std::size_t>(settings.resamples));
    for (double& mean : means) {
        BlockSum total;
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            const BlockSum& block = blocks[random.below(blocks.size())];
            total.sum += block.sum;
            total.values += block.values;
        }
        mean = total.sum / static_cast<double>(total.values);
    }
    return with_percentiles(value, std::move(means));
}

Estimate bootstrap_of_draws(std::size_t blocks, const std::function<double(const std::vector<double>&)>& statistic,
                            const BootstrapSettings& settings) {
    require_resamples(settings.resamples);
    const double value = statistic(std::vector<double>(blocks, 1.0));
    Random random(settings.seed);
    std::vector<double> drawn;
    for (int i = 0; i < settings.resamples; ++i) {
        const double of_draw = statistic(draw_counts(random, blocks));
        if (std::isfinite(of_draw)) drawn.push_back(of_draw);
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (drawn.size() < static_cast<std::size_t>(fewest_resamples)) return {value, -infinity, infinity};
    return with_percentiles(value, std::move(drawn));
}

void BlockSeries::add(std::vector<BlockSum> frame) {
    if (!frames_.empty() && frames_.front().size() != frame.size()) {
        throw ImageError(
            fmt::format("a frame of {} blocks does not fit into a series with {} blocks per frame; all "
                        "frames of a path must have one size",
                        frame.size(), frames_.front().size()));
    }
    frames_.push_back(std::move(frame));
}

Estimate BlockSeries::mean(const BootstrapSettings& settings) const {
    if (frames_.empty()) return bootstrap_mean({}, settings);
    if (frames_.size() == 1) return bootstrap_mean(frames_.front(), settings);
    require_resamples(settings.resamples);
    const auto runs = in_runs(frames_, longest_run_);
    std::vector<BlockSum> all;
    for (const auto& run : runs) all.insert(all.end(), run.begin(), run.end());
    const double value = mean_of(all);
    if (std::isnan(value)) return {value, value, value};

    Random random(settings.seed);
    std::vector<double> means;
    while (means.size() < static_cast<std::size_t>(settings.resamples)) {
        const std::vector<double> of_blocks = draw_counts(random, runs.front().size()),
                                  of_runs = draw_counts(random, runs.size());
        double sum = 0.0, values = 0.0;
        for (std::size_t r = 0; r < runs.size(); ++r) {
            if (of_runs[r] == 0.0) continue;
            for (std::size_t b = 0; b < of_blocks.size(); ++b) {
                sum += of_runs[r] * of_blocks[b] * runs[r][b].sum;
                values += of_runs[r] * of_blocks[b] * static_cast<double>(runs[r][b].values);
            }
        }
        // A draw may miss all that holds values; some block does, so another draw finds it.
        if (values > 0.0) means.push_back(sum / values);
    }
    return with_percentiles(value, std::move(means));
}

}  // namespace plumb

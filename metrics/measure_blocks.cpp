#include "metrics/measure_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "frames/parallel.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

double square(double value) { return value * value; }

}  // namespace

Estimate decibels(const Estimate& mse, double peak) {
    // Not std::max, which would make a zero of a NaN.
    const auto of = [&](double x) { return 10.0 * std::log10(square(peak) / (x < 0.0 ? 0.0 : x)); };
    return {of(mse.value), of(mse.upper), of(mse.lower)};
}

MeasureBlocks pixel_error_blocks(const Image& test, const Image& reference, const PixelErrors& errors,
                                 const BlockGrid& grid, const Image* mask) {
    MeasureBlocks blocks;
    for (const MeanMeasure& measure : mean_measures) (blocks.*measure.blocks).resize(grid.count());
    for (auto& below : blocks.below) below.resize(grid.count());
    const auto for_each_value = [&](int begin, int end, const auto& use) {
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < test.width(); ++x) {
                if (!pixel_counts(mask, x, y)) continue;
                for (int c = 0; c < test.channels(); ++c) {
                    const double v = test.at(x, y, c), r = reference.at(x, y, c);
                    if (std::isfinite(v) && std::isfinite(r)) use(grid.block_of(x, y), v, r);
                }
            }
        }
    };
    // A row of blocks belongs to one thread: the same bits whatever the number of threads.
    parallel_for(grid.rows(), [&](int row) {
        const int begin = row * grid.block_size(), end = std::min(test.height(), begin + grid.block_size());
        for_each_value(begin, end, [&](std::size_t block, double v, double r) {
            const double difference = v - r, squared = square(difference);
            blocks.mae[block].add(std::abs(difference));
            blocks.mse[block].add(squared);
            blocks.bias[block].add(difference);
            blocks.relative_mse_pbrt[block].add(squared / relative_weight_pbrt(r));
            blocks.relative_mse_tev[block].add(squared / relative_weight_tev(r));
            blocks.relative_mse_falcor[block].add(squared / relative_weight_falcor(r));
            for (std::size_t i = 0; i < percentile_measures.size(); ++i)
                blocks.below[i][block].add(std::abs(difference) <= errors.*percentile_measures[i].value ? 1.0 : 0.0);
        });
    });
    QuantileCounter magnitudes;
    for_each_value(0, test.height(),
                   [&](std::size_t, double v, double r) { magnitudes.add(static_cast<float>(std::abs(v - r))); });
    blocks.magnitudes = magnitudes.curve();
    return blocks;
}

std::vector<BlockSum> block_sums(const Image& map, const BlockGrid& grid, const Image* mask) {
    std::vector<BlockSum> blocks(grid.count());
    for (int y = 0; y < map.height(); ++y) {
        for (int x = 0; x < map.width(); ++x) {
            if (pixel_counts(mask, x, y) && std::isfinite(map.at(x, y))) blocks[grid.block_of(x, y)].add(map.at(x, y));
        }
    }
    return blocks;
}

Estimate percentile_interval(double value, double level, const Estimate& share, const QuantileCurve& magnitudes) {
    // The curve knows a quantile to a thousandth only, and could otherwise leave the percentile itself out.
    return {value, std::min(value, magnitudes.at(level + (share.lower - share.value))),
            std::max(value, magnitudes.at(level + (share.upper - share.value)))};
}

Estimate MeasureIntervals::of(std::string_view name) const {
    for (const auto& [known, estimate] : estimates_) {
        if (known == name) return estimate;
    }
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none, none};
}

void MeasureIntervals::set(std::string name, const Estimate& estimate) {
    estimates_.emplace_back(std::move(name), estimate);
}

void MeasureIntervals::set_mse(const Estimate& mse, double peak) {
    set("mse", mse);
    set("rmse", mse.root());
    set("psnr", decibels(mse, peak));
}

void MeasureIntervals::replace_in(std::vector<std::pair<std::string, double>>& measures) const {
    for (auto& [name, value] : measures) {
        const std::string_view whole = name;
        const bool lower = whole.ends_with("_lower"), upper = whole.ends_with("_upper");
        const std::string_view stem = lower || upper ? whole.substr(0, whole.size() - 6) : whole;
        for (const auto& [known, estimate] : estimates_) {
            if (known == stem) value = lower ? estimate.lower : upper ? estimate.upper : estimate.value;
        }
    }
}

MeasureIntervals measure_intervals(const MeasureBlocks& blocks, const PixelErrors& errors,
                                   const BootstrapSettings& settings) {
    std::array<Estimate, mean_measures.size() + percentile_measures.size()> estimates;
    parallel_for(static_cast<int>(estimates.size()), [&](int i) {
        const auto place = static_cast<std::size_t>(i);
        estimates[place] = bootstrap_mean(place < mean_measures.size() ? blocks.*mean_measures[place].blocks
                                                                       : blocks.below[place - mean_measures.size()],
                                          settings);
    });
    MeasureIntervals intervals;
    for (std::size_t i = 0; i < mean_measures.size(); ++i) {
        if (mean_measures[i].name == "mse")
            intervals.set_mse(estimates[i], errors.peak);
        else
            intervals.set(std::string(mean_measures[i].name), estimates[i]);
    }
    for (std::size_t i = 0; i < percentile_measures.size(); ++i) {
        const PercentileMeasure& percentile = percentile_measures[i];
        intervals.set(std::string(percentile.name),
                      percentile_interval(errors.*percentile.value, percentile.level,
                                          estimates[mean_measures.size() + i], blocks.magnitudes));
    }
    return intervals;
}

}  // namespace plumb

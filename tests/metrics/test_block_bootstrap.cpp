#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "frames/image_error.h"
#include "metrics/block_bootstrap.h"

namespace plumb {
namespace {

// One value per block.
std::vector<BlockSum> blocks_of(const std::vector<double>& values) {
    std::vector<BlockSum> blocks;
    blocks.reserve(values.size());
    for (const double value : values) blocks.push_back({value, 1});
    return blocks;
}

TEST(BlockGrid, HalvesItsBlocksUntilSixtyFourHoldPixels) {
    EXPECT_EQ(BlockGrid(480, 270, 32).block_size(), 32) << "15 x 9 blocks";
    EXPECT_EQ(BlockGrid(64, 64, 32).block_size(), 8) << "8 x 8 blocks";
    EXPECT_EQ(BlockGrid(4, 4, 32).block_size(), 1);
    Image left(480, 270, 1);
    for (int y = 0; y < 270; ++y) {
        for (int x = 0; x < 120; ++x) left.at(x, y) = 1.0f;
    }
    const BlockGrid grid(480, 270, 32, &left);
    EXPECT_EQ(grid.block_size(), 16) << "4 x 9 blocks of 32 hold pixels, 8 x 17 of 16";
    EXPECT_EQ(grid.block_of(17, 33), 2u * 30 + 1);
    EXPECT_THROW(BlockGrid(2, 2, 32, &left), ImageError);
}

TEST(BootstrapMean, WeighsBlocksByTheirValuesAndNeedsMoreThanOne) {
    const Estimate mean = bootstrap_mean({{6.0, 2}, {3.0, 1}, {0.0, 0}});
    EXPECT_DOUBLE_EQ(mean.value, 3.0);
    EXPECT_DOUBLE_EQ(mean.lower, 3.0) << "both blocks have mean 3";
    EXPECT_DOUBLE_EQ(mean.upper, 3.0);
    const Estimate single = bootstrap_mean({{6.0, 2}});
    EXPECT_DOUBLE_EQ(single.value, 3.0);
    EXPECT_TRUE(std::isinf(single.lower) && std::isinf(single.upper)) << "one block says nothing of the spread";
    EXPECT_TRUE(std::isnan(bootstrap_mean({}).value));
    EXPECT_THROW(bootstrap_mean({{1, 1}}, {.resamples = 39}), ImageError);
}

TEST(BootstrapMean, OfTwoBlocksIsTheBinomialDrawnByHand) {
    // Draws of two from {0, 1}: mean 0 or 1 with probability a quarter each, so that both are within the 2.5 % tails.
    const Estimate mean = bootstrap_mean(blocks_of({0.0, 1.0}));
    EXPECT_DOUBLE_EQ(mean.lower, 0.0);
    EXPECT_DOUBLE_EQ(mean.upper, 1.0);
}

TEST(BootstrapMean, IsAsWideAsTheStandardErrorOfTheMeanSays) {
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    std::vector<double> values(400);
    double sum = 0, squares = 0;
    for (double& value : values) value = normal(random), sum += value, squares += value * value;
    const double standard_error = std::sqrt((squares / 400 - sum / 400 * sum / 400) / 399);
    const Estimate mean = bootstrap_mean(blocks_of(values), {.resamples = 20000});
    // 20000 draws find a 2.5 % quantile of a normal variable to within 0.019 standard errors (one sigma); four of them.
    EXPECT_NEAR(mean.lower, mean.value - 1.96 * standard_error, 0.08 * standard_error);
    EXPECT_NEAR(mean.upper, mean.value + 1.96 * standard_error, 0.08 * standard_error);
}

// SciPy 1.10.1 (Debian 12):
//
//   import numpy as np
//   from scipy.stats import bootstrap
//   data = ((np.arange(100) * 37 % 101) / 100.0)**3
//   bootstrap((data,), np.mean, n_resamples=200000, method='percentile', random_state=1, batch=10000)
TEST(BootstrapMean, MatchesSciPy) {
    std::vector<double> values(100);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::pow(static_cast<double>(i * 37 % 101) / 100.0, 3);
    const Estimate mean = bootstrap_mean(blocks_of(values), {.resamples = 20000});
    EXPECT_NEAR(mean.value, 0.25240356, 1e-12);
    // The standard error is 0.029; 20000 draws find a tail to within 0.019 of it (one sigma): four of them.
    EXPECT_NEAR(mean.lower, 0.19685561, 0.0022);
    EXPECT_NEAR(mean.upper, 0.31024428, 0.0022);
}

TEST(BootstrapOfDraws, OfAMeanIsThatOfTheMean) {
    std::vector<double> values(100);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::pow(static_cast<double>(i * 37 % 101) / 100.0, 3);
    const auto mean = [&](const std::vector<double>& counts) {
        double sum = 0;
        for (std::size_t i = 0; i < values.size(); ++i) sum += counts[i] * values[i];
        return sum / 100.0;
    };
    const Estimate drawn = bootstrap_of_draws(100, mean, {.resamples = 20000});
    // SciPy's, as above.
    EXPECT_NEAR(drawn.value, 0.25240356, 1e-12);
    EXPECT_NEAR(drawn.lower, 0.19685561, 0.0022);
    EXPECT_NEAR(drawn.upper, 0.31024428, 0.0022);
    EXPECT_TRUE(std::isinf(bootstrap_of_draws(100, [](const auto&) { return NAN; }).upper));
}

TEST(Estimate, RootOfAnUnbiasedSquareBelowZeroIsZero) {
    const Estimate root = Estimate{0.25, -0.01, 4.0}.root();
    EXPECT_DOUBLE_EQ(root.value, 0.5);
    EXPECT_DOUBLE_EQ(root.lower, 0.0);
    EXPECT_DOUBLE_EQ(root.upper, 2.0);
    EXPECT_TRUE(std::isnan(Estimate{NAN, NAN, NAN}.root().value));
}

// Share of draws in which the interval of a series holds its true mean of 1. Each frame's each block shows
// 1 + place[block] + moment[frame] + single[frame][block].
double coverage(double place_sigma, double moment_sigma, double single_sigma, std::size_t frames) {
    constexpr int draws = 200;
    constexpr std::size_t blocks = 64;
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    int covered = 0;
    for (int draw = 0; draw < draws; ++draw) {
        std::vector<double> place(blocks);
        for (double& value : place) value = place_sigma * normal(random);
        BlockSeries series;
        for (std::size_t frame = 0; frame < frames; ++frame) {
            std::vector<double> values(blocks, 1.0 + moment_sigma * normal(random));
            for (std::size_t b = 0; b < blocks; ++b) values[b] += place[b] + single_sigma * normal(random);
            series.add(blocks_of(values));
        }
        const Estimate mean = series.mean({.resamples = 200});
        covered += mean.lower <= 1.0 && 1.0 <= mean.upper;
    }
    return static_cast<double>(covered) / draws;
}

TEST(BlockSeries, IntervalHoldsTheMeanWhateverItIsThatVaries) {
    // 200 draws have a standard error of 1.5 %; percentile intervals of 64 blocks are slightly narrow (94 %), and 200
    // resamples cost another percent.
    EXPECT_GE(coverage(1, 0, 0, 16), 0.89) << "what sticks to places";
    EXPECT_LE(coverage(1, 0, 0, 16), 0.99);
    // 8 runs make percentile intervals narrow (Student's t of 7 degrees is 2.36 where the normal has 1.96).
    EXPECT_GE(coverage(0, 1, 0, 16), 0.80) << "what hits all places of a frame";
    EXPECT_GE(coverage(0, 1, 0, 256), 0.89) << "32 runs";
    EXPECT_GE(coverage(0, 0, 1, 16), 0.95) << "single values: wider than need be";
}

TEST(BlockSeries, OfOneFrameIsThatFrameAndRefusesFramesOfOtherSizes) {
    const std::vector<double> values = {1, 2, 3, 4, 10};
    BlockSeries series;
    series.add(blocks_of(values));
    const Estimate of_series = series.mean(), of_frame = bootstrap_mean(blocks_of(values));
    EXPECT_EQ(of_series.value, of_frame.value);
    EXPECT_EQ(of_series.lower, of_frame.lower);
    EXPECT_EQ(of_series.upper, of_frame.upper);
    EXPECT_THROW(series.add(blocks_of({1, 2})), ImageError);
    EXPECT_TRUE(std::isnan(BlockSeries().mean().value));
}

}  // namespace
}  // namespace plumb

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "frames/image_error.h"
#include "metrics/comparison.h"
#include "metrics/measure_blocks.h"

namespace plumb {
namespace {

MeasureIntervals intervals_of(const Image& test, const Image& reference, double peak, const BlockGrid& grid,
                              const BootstrapSettings& settings = {}) {
    const PixelErrors errors = pixel_errors(test, reference, peak);
    return measure_intervals(pixel_error_blocks(test, reference, errors, grid), errors, settings);
}

TEST(QuantileCurve, KnowsQuantilesToAThousandth) {
    QuantileCounter counter;
    std::mt19937 random(2);
    std::exponential_distribution<float> exponential;
    std::vector<float> values(100'001);
    for (float& value : values) counter.add(value = exponential(random));
    std::ranges::sort(values);
    const QuantileCurve curve = counter.curve();
    for (const double level : {0.25, 0.5, 0.95, 0.999}) {
        const double exact = values[static_cast<std::size_t>(std::lround(level * 100'000))];
        EXPECT_NEAR(curve.at(level), exact, 0.001 * exact);
    }
    EXPECT_NEAR(curve.at(1.5), values.back(), 0.001 * values.back()) << "beyond the last level";
    EXPECT_NEAR(curve.at(-0.5), values.front(), 0.001 * values.front());
    EXPECT_TRUE(std::isnan(QuantileCurve().at(0.5)));
}

TEST(QuantileCurve, TellsZeroApartAndSurvivesTheLargestValues) {
    QuantileCounter counter;
    for (int i = 0; i < 99; ++i) counter.add(0.0f);
    for (int i = 0; i < 99; ++i) counter.add(std::numeric_limits<float>::infinity());
    EXPECT_EQ(counter.curve().at(0.25), 0.0);
    EXPECT_GT(counter.curve().at(0.75), 1e38);
}

TEST(QuantileCurve, AveragesLevelByLevel) {
    QuantileCounter ones, threes;
    ones.add(1.0f), threes.add(3.0f);
    QuantileCurve mean;
    mean.average_in(QuantileCurve(), 0);
    mean.average_in(ones.curve(), 0);
    mean.average_in(threes.curve(), 1);
    mean.average_in(threes.curve(), 2);
    EXPECT_NEAR(mean.at(0.5), 7.0 / 3, 0.003);
}

TEST(MeasureIntervals, OfTwoBlocksAreDrawnByHand) {
    // Both draw the same block twice with probability a quarter: the tails are the values of either block.
    Image test(2, 1, 1, 0.49f);
    test.at(1, 0) = 0.99f;
    const MeasureIntervals intervals = intervals_of(test, Image(2, 1, 1, 0.49f), 1.0, BlockGrid(2, 1, 32));
    constexpr double float32 = 1e-7;  // rounding of 0.49 and 0.99
    const std::map<std::string, double> of_second = {{"mae", 0.5},
                                                     {"mse", 0.25},
                                                     {"rmse", 0.5},
                                                     {"bias", 0.5},
                                                     {"relative_mse_pbrt", 0.25 / (0.5 * 0.5)},
                                                     {"relative_mse_tev", 0.25 / (0.49 * 0.49 + 0.01)},
                                                     {"relative_mse_falcor", 0.25 / (0.49 * 0.49 + 0.001)},
                                                     {"p99", 0.5}};
    for (const auto& [name, value] : of_second) {
        EXPECT_NEAR(intervals.of(name).lower, 0.0, float32) << name;
        EXPECT_NEAR(intervals.of(name).upper, value, name == "p99" ? 0.001 * value : 20 * float32) << name;
    }
    EXPECT_NEAR(intervals.of("psnr").lower, 10 * std::log10(4.0), 1e-5);
    EXPECT_EQ(intervals.of("psnr").upper, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(intervals.of("flip").value)) << "there is none";
    EXPECT_TRUE(std::isnan(intervals.of("maximum").lower)) << "no draw shows what the image does not";
}

TEST(MeasureIntervals, OfAMedianAreTheRanksThatTheBinomialGives) {
    // Errors 1 to 400, a pixel each: of 400 draws 200 +- 1.96 sqrt(400 / 4) lie below the median, so that its interval
    // runs from the 180th to the 220th. 1000 draws know the tails to within 0.05 standard deviations of 10 (one sigma).
    Image test(20, 20, 1), reference(20, 20, 1);
    for (int i = 0; i < 400; ++i) test.at(i % 20, i / 20) = static_cast<float>((i * 37) % 400 + 1);
    const MeasureIntervals intervals = intervals_of(test, reference, 1.0, BlockGrid(20, 20, 1));
    EXPECT_NEAR(intervals.of("median").value, 200.5, 1e-6);
    EXPECT_NEAR(intervals.of("median").lower, 180.5, 2.0);
    EXPECT_NEAR(intervals.of("median").upper, 220.5, 2.0);
    // Four errors lie above the 99th percentile; of 400 draws 1 to 8 do (binomial of 0.01: none in 1.8 % of the draws,
    // nine and more in 2.1 %): from the 392nd to the 399th of the errors.
    EXPECT_NEAR(intervals.of("p99").lower, 392.1, 0.6);
    EXPECT_NEAR(intervals.of("p99").upper, 399.0, 0.6);
}

// SciPy 1.10.1 (Debian 12), which draws the values themselves and takes the percentile of each draw:
//
//   data = ((np.arange(100) * 37 % 101) / 100.0)**3
//   many = dict(n_resamples=100000, method='percentile', random_state=1, batch=10000)
//   bootstrap((data,), lambda a, axis=-1: np.median(a, axis=axis), **many)          # 0.0640, 0.2056
//   bootstrap((data,), lambda a, axis=-1: np.percentile(a, 95, axis=axis), **many)  # 0.7074, 0.9426
//   bootstrap((data,), lambda a, axis=-1: np.sqrt((a * a).mean(axis=axis)), **many) # 0.3180, 0.4443
TEST(MeasureIntervals, MatchSciPy) {
    Image test(10, 10, 1), reference(10, 10, 1);
    for (int i = 0; i < 100; ++i) test.at(i % 10, i / 10) = static_cast<float>(std::pow((i * 37 % 101) / 100.0, 3));
    const MeasureIntervals intervals = intervals_of(test, reference, 1.0, BlockGrid(10, 10, 1), {.resamples = 20000});
    // A hundred values: neighbours in their order are 0.008 apart at the median's ends and 0.03 apart at the 95th
    // percentile's; a draw may end at either.
    EXPECT_NEAR(intervals.of("median").lower, 0.0640, 0.008);
    EXPECT_NEAR(intervals.of("median").upper, 0.2056, 0.011);
    EXPECT_NEAR(intervals.of("p95").lower, 0.7074, 0.03);
    EXPECT_NEAR(intervals.of("p95").upper, 0.9426, 0.03);
    // Standard error 0.032; as for the mean (test_block_bootstrap.cpp).
    EXPECT_NEAR(intervals.of("rmse").lower, 0.3180, 0.0025);
    EXPECT_NEAR(intervals.of("rmse").upper, 0.4443, 0.0025);
}

TEST(MeasureIntervals, OfAnErrorThatIsTheSameEverywhereHaveNoWidth) {
    const MeasureIntervals intervals =
        intervals_of(Image(16, 16, 1, 0.75f), Image(16, 16, 1, 0.5f), 1.0, BlockGrid(16, 16, 2));
    for (const char* name : {"mae", "mse", "rmse", "bias", "relative_mse_tev", "psnr", "median", "p95", "p99"}) {
        const Estimate of = intervals.of(name);
        EXPECT_NEAR(of.lower, of.value, 0.001 * of.value) << name;
        EXPECT_NEAR(of.upper, of.value, 0.001 * of.value) << name;
    }
}

// How many of the draws have an interval that holds the answer.
class Coverage {
public:
    void add(const std::string& name, const Estimate& estimate) { estimates_[name].push_back(estimate); }
    double of(const std::string& name, double answer) const {
        double held = 0;
        for (const Estimate& estimate : estimates_.at(name))
            held += estimate.lower <= answer && answer <= estimate.upper;
        return held / static_cast<double>(estimates_.at(name).size());
    }
    // Against the mean over all draws, for measures whose expectation no formula gives.
    double of_mean(const std::string& name) const {
        double sum = 0;
        for (const Estimate& estimate : estimates_.at(name)) sum += estimate.value;
        return of(name, sum / static_cast<double>(estimates_.at(name).size()));
    }

private:
    std::map<std::string, std::vector<Estimate>> estimates_;
};

TEST(MeasureIntervals, HoldTheKnownAnswerInNineteenOfTwentyDraws) {
    // Errors of pixels are exponential with mean 1 in half of the blocks, with mean 3 in the others, over 100 blocks.
    Coverage coverage;
    constexpr int draws = 200;
    std::mt19937 random(5);
    for (int draw = 0; draw < draws; ++draw) {
        Image test(80, 80, 1), reference(80, 80, 1, 0.99f);
        std::array<float, 100> scales;
        for (float& scale : scales) scale = random() % 2 == 0 ? 1.0f : 3.0f;
        std::exponential_distribution<float> exponential;
        for (int y = 0; y < 80; ++y) {
            for (int x = 0; x < 80; ++x) {
                const int block = y / 8 * 10 + x / 8;
                test.at(x, y) = 0.99f + scales[static_cast<std::size_t>(block)] * exponential(random);
            }
        }
        const MeasureIntervals intervals =
            intervals_of(test, reference, 10.0, BlockGrid(80, 80, 8), {.block_size = 8, .resamples = 200});
        for (const char* name : {"mae", "bias", "mse", "rmse", "psnr", "relative_mse_pbrt", "median", "p95", "p99"})
            coverage.add(name, intervals.of(name));
    }
    // Where exp(-x) + exp(-x / 3) is twice the share above, by bisection.
    const auto percentile = [](double p) {
        double low = 0, high = 50;
        for (int i = 0; i < 60; ++i) {
            const double x = 0.5 * (low + high);
            (std::exp(-x) + std::exp(-x / 3) > 2 * (1 - p) ? low : high) = x;
        }
        return low;
    };
    const std::map<std::string, double> answers = {{"mae", 2.0},
                                                   {"bias", 2.0},
                                                   {"mse", 10.0},  // (2 + 18) / 2
                                                   {"rmse", std::sqrt(10.0)},
                                                   {"psnr", 10.0},
                                                   {"relative_mse_pbrt", 10.0},  // below stands (0.99 + 0.01)^2
                                                   {"median", percentile(0.5)},
                                                   {"p95", percentile(0.95)},
                                                   {"p99", percentile(0.99)}};
    for (const auto& [name, answer] : answers) {
        // 200 draws have a standard error of 1.5 %; see BlockSeries for why 0.94 is what to expect.
        EXPECT_GE(coverage.of(name, answer), 0.89) << name;
        EXPECT_LE(coverage.of(name, answer), 0.99) << name;
    }
}

TEST(MeasureIntervals, OfSsimAndFlipHoldTheirMeansToo) {
    // Noise that is strong in some blocks of 24 pixels, on a slope; 64 blocks.
    Coverage coverage;
    constexpr int draws = 60, size = 192;
    Image reference(size, size, 1);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) reference.at(x, y) = 0.2f + 0.003f * static_cast<float>(x);
    }
    ComparisonSettings settings;
    settings.flip = FlipRange::displayed;
    settings.pixels_per_degree = 20;  // filters narrower than the blocks
    settings.referenced.bootstrap = {.block_size = 24, .resamples = 200};
    std::mt19937 random(7);
    for (int draw = 0; draw < draws; ++draw) {
        Image test = reference;
        std::array<float, 64> strengths;
        for (float& strength : strengths) strength = random() % 2 == 0 ? 0.02f : 0.2f;
        std::uniform_real_distribution<float> noise(-1.0f, 1.0f);
        // Points four pixels wide, which are still there at the coarser scales.
        for (int y = 0; y < size; y += 4) {
            for (int x = 0; x < size; x += 4) {
                const int block = y / 24 * 8 + x / 24;
                const float change = strengths[static_cast<std::size_t>(block)] * noise(random);
                for (int i = 0; i < 16; ++i) test.at(x + i % 4, y + i / 4) += change;
            }
        }
        const PlaneComparison comparison = compare_planes(test, reference, settings, "ao");
        for (const char* name : {"ssim", "ms_ssim", "flip"}) {
            Estimate estimate = comparison.intervals.of(name);
            EXPECT_NEAR(estimate.value, comparison.measure(name), 1e-6) << name << ": the mean of the block sums";
            coverage.add(name, estimate);
        }
    }
    // 60 draws have a standard error of 2.8 %: three of them below 0.95. Windows reach over the blocks' edges, which
    // makes intervals a little narrow; those of the coarser scales of MS-SSIM span several blocks (ssim.h).
    EXPECT_GE(coverage.of_mean("ssim"), 0.86);
    EXPECT_GE(coverage.of_mean("flip"), 0.86);
    EXPECT_GE(coverage.of_mean("ms_ssim"), 0.80);
    // And not by being as wide as can be.
    EXPECT_LT(coverage.of("ssim", 1.0), 0.1);
    EXPECT_LT(coverage.of("ms_ssim", 1.0), 0.1);
    EXPECT_LT(coverage.of("flip", 0.0), 0.1);
}

}  // namespace
}  // namespace plumb

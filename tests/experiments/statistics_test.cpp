#include "experiments/statistics.h"

#include <cmath>

#include <gtest/gtest.h>

#include "experiments/ratio_text.h"

namespace plumb {
namespace {

TEST(Quantile, InterpolatesBetweenOrderStatistics) {
    EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
    EXPECT_DOUBLE_EQ(quantile({5, 1, 3}, 0.5), 3);
    EXPECT_DOUBLE_EQ(quantile({1, 2, 3, 4, 5}, 0.25), 2);
    EXPECT_DOUBLE_EQ(quantile({7}, 0.75), 7);
}

TEST(RatioSummary, TheMeanOfAHalfAndItsInverseIsOne) {
    const RatioSummary summary = summarise_ratios({0.5, 2.0});
    EXPECT_DOUBLE_EQ(summary.mean, 1.0);
    EXPECT_EQ(summary.below_one, 1);
    // By hand: logarithms -+ ln 2, their standard error is ln 2, Student's t for one degree of freedom is 12.706.
    EXPECT_NEAR(std::log(summary.upper), 12.706 * std::log(2.0), 1e-9);
    EXPECT_NEAR(std::log(summary.lower), -12.706 * std::log(2.0), 1e-9);
}

TEST(RatioSummary, EqualRatiosHaveAnIntervalWithoutWidth) {
    const RatioSummary summary = summarise_ratios({0.8, 0.8, 0.8});
    EXPECT_NEAR(summary.lower, 0.8, 1e-12);
    EXPECT_NEAR(summary.upper, 0.8, 1e-12);
    EXPECT_EQ(summary.below_one, 3);
}

TEST(RatioSummary, ASingleRatioKnowsNoInterval) {
    const RatioSummary summary = summarise_ratios({0.8});
    EXPECT_DOUBLE_EQ(summary.mean, 0.8);
    EXPECT_TRUE(std::isinf(summary.upper));
    EXPECT_FALSE(summary.has_interval());
}

TEST(RatioText, HasDigitsUntilNoEndIsRoundedToOne) {
    const auto text = [](double mean, double lower, double upper, int count = 3) {
        const RatioText ratio = print_ratio({mean, lower, upper, count, 0});
        return ratio.mean + " " + ratio.lower + " " + ratio.upper;
    };
    EXPECT_EQ(text(0.97, 0.94, 1.01), "0.97 0.94 1.01");
    EXPECT_EQ(text(0.97, 0.9412, 1.0031), "0.970 0.941 1.003");
    EXPECT_EQ(text(1.0314, 0.99968, 1.08), "1.0314 0.9997 1.0800");
    EXPECT_EQ(text(1.0, 1.0, 1.0), "1.00 1.00 1.00") << "no digit would show a side";
    EXPECT_EQ(text(1.0, 1.0 - 1e-15, 1.0 + 1e-15), "1.00 1.00 1.00") << "nor here";
    EXPECT_EQ(text(1.0, 1.0 - 1e-8, 1.0 + 1e-8), "1.000000 1.000000 1.000000");
    EXPECT_EQ(text(1.0004, 0.5, 2.0), "1.00 0.50 2.00") << "the mean has no side to show";
    EXPECT_EQ(text(0.5, 0.0, 112.0, 2), "0.50  ");
}

}  // namespace
}  // namespace plumb

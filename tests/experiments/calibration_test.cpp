// The rule that sets limits, against values computed by hand.
#include "experiments/calibration.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/message_of.h"

namespace plumb {
namespace {

Threshold threshold_with(ThresholdKind kind, const CalibratedValue& value) {
    Threshold threshold;
    threshold.name = "t";
    threshold.kind = kind;
    threshold.calibrated = value;
    return threshold;
}

TEST(Calibration, PoolsRunsAsIfTheyWereOneSeries) {
    // 1, 2, 3, 6: mean 3, squares 4 + 1 + 0 + 9 = 14, spread sqrt(14 / 3).
    const CalibratedValue at_once = pool({1, 2, 3, 6});
    EXPECT_EQ(at_once.runs, 4);
    EXPECT_DOUBLE_EQ(at_once.mean, 3.0);
    EXPECT_DOUBLE_EQ(at_once.spread, std::sqrt(14.0 / 3.0));
    EXPECT_EQ(at_once.least, 1.0);
    EXPECT_EQ(at_once.greatest, 6.0);
    const CalibratedValue in_two = pool({3, 6}, pool({1, 2}));
    EXPECT_EQ(in_two.runs, 4);
    EXPECT_NEAR(in_two.mean, 3.0, 1e-14);
    EXPECT_NEAR(in_two.spread, at_once.spread, 1e-14);
    EXPECT_EQ(in_two.least, 1.0);
    EXPECT_EQ(in_two.greatest, 6.0);
    EXPECT_EQ(pool({5}).spread, 0.0);
}

TEST(Calibration, RoundsAwayFromTheValue) {
    EXPECT_DOUBLE_EQ(round_outwards(0.12341, true), 0.124);
    EXPECT_DOUBLE_EQ(round_outwards(0.12341, false), 0.123);
    EXPECT_DOUBLE_EQ(round_outwards(9.991, true), 10.0);
    EXPECT_DOUBLE_EQ(round_outwards(123456.0, true), 124000.0);
    EXPECT_DOUBLE_EQ(round_outwards(-0.12341, true), -0.123) << "up is towards zero here";
    EXPECT_DOUBLE_EQ(round_outwards(-0.12341, false), -0.124);
    EXPECT_DOUBLE_EQ(round_outwards(0.123, true), 0.123) << "has three digits already";
    EXPECT_EQ(round_outwards(0.0, true), 0.0);
}

TEST(Calibration, LimitsLieFourSpreadsAway) {
    Threshold threshold = threshold_with(ThresholdKind::cost, {10, 2.0, 0.1, 1.9, 2.1});
    EXPECT_DOUBLE_EQ(calibrated_limit(threshold, 0.0), 2.4);
    threshold.fails_above = false;
    EXPECT_DOUBLE_EQ(calibrated_limit(threshold, 0.0), 1.6);
}

TEST(Calibration, LimitsAreNotTighterThanTheNoiseOfTheirKind) {
    Threshold threshold = threshold_with(ThresholdKind::cost, {10, 2.0, 0.01, 1.9, 2.1});
    EXPECT_DOUBLE_EQ(calibrated_limit(threshold, 0.1), 2.8)
        << "four times a tenth of 2, though its own spread is a twentieth of that";
}

TEST(Calibration, ValuesWithoutSpreadKeepAFloor) {
    EXPECT_DOUBLE_EQ(calibrated_limit(threshold_with(ThresholdKind::error, {10, 0.5, 0.0, 0.5, 0.5}), 0.0), 0.51)
        << "2 %";
    EXPECT_DOUBLE_EQ(calibrated_limit(threshold_with(ThresholdKind::cost, {10, 0.5, 0.0, 0.5, 0.5}), 0.0), 0.55)
        << "10 %";
    Threshold along_path = threshold_with(ThresholdKind::flicker, {10, 0.5, 0.0, 0.5, 0.5});
    along_path.rows.path = "*";
    EXPECT_DOUBLE_EQ(calibrated_limit(along_path, 0.0), 0.55) << "10 %";
    Threshold below = threshold_with(ThresholdKind::error, {10, -0.5, 0.0, -0.5, -0.5});
    below.fails_above = false;
    EXPECT_DOUBLE_EQ(calibrated_limit(below, 0.0), -0.51);
}

TEST(Calibration, NoRunThatWasSeenBreaksItsLimit) {
    EXPECT_DOUBLE_EQ(calibrated_limit(threshold_with(ThresholdKind::cost, {40, 2.0, 0.1, 1.9, 3.0}), 0.0), 3.0);
}

TEST(Calibration, NothingFollowsFromZero) {
    const std::string message = message_of<ConfigError>([] {
        calibrated_limit(threshold_with(ThresholdKind::error, {10, 0.0, 0.0, 0.0, 0.0}), 0.0);
    });
    EXPECT_THAT(message, testing::HasSubstr("zero in every run"));
}

TEST(Calibration, PoolsRelativeSpreadsByKind) {
    // sqrt((0.1^2 * 9 + 0.2^2 * 4) / 13); the error's spread has no part in it.
    const std::vector<Threshold> thresholds = {threshold_with(ThresholdKind::cost, {10, 2.0, 0.2, 0, 0}),
                                               threshold_with(ThresholdKind::cost, {5, 1.0, 0.2, 0, 0}),
                                               threshold_with(ThresholdKind::error, {10, 1.0, 0.9, 0, 0})};
    EXPECT_DOUBLE_EQ(pooled_relative_spread(thresholds, ThresholdKind::cost), std::sqrt((0.09 + 0.16) / 13));
    EXPECT_EQ(pooled_relative_spread(thresholds, ThresholdKind::flicker), 0.0);
}

TEST(Calibration, StartsAnewUnlessRunsAreAdded) {
    std::vector<Threshold> thresholds = {threshold_with(ThresholdKind::cost, {2, 1.0, 0.0, 1.0, 1.0})};
    EXPECT_EQ(calibrate(thresholds, {{2.0, 2.0}}, false)[0].calibrated->mean, 2.0);
    const Threshold added = calibrate(thresholds, {{2.0, 2.0}}, true)[0];
    EXPECT_EQ(added.calibrated->runs, 4);
    EXPECT_DOUBLE_EQ(added.calibrated->mean, 1.5);
    // Squares 4 * 0.25 over 3: a spread of 0.57735; 1.5 + 4 * 0.57735 = 3.8094.
    EXPECT_DOUBLE_EQ(*added.limit, 3.81);
}

}  // namespace
}  // namespace plumb

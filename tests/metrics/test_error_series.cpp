#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "frames/image_error.h"
#include "metrics/error_series.h"

namespace plumb {
namespace {

constexpr int side = 32;

Frame with_plane(float value) {
    Frame frame(side, side);
    frame.set("ao", Image(side, side, 1, value));
    return frame;
}

Frame truth_of(float half_a, float half_b) {
    Frame frame(side, side);
    frame.set("half_a.ao", Image(side, side, 1, half_a));
    frame.set("half_b.ao", Image(side, side, 1, half_b));
    return frame;
}

TEST(StudentMean, IsThatOfAnyTable) {
    // 4 degrees of freedom: 2.776; deviation of 1..5 sqrt(2.5), of their mean sqrt(0.5).
    const Estimate mean = student_mean({1, 2, 3, 4, 5});
    EXPECT_DOUBLE_EQ(mean.value, 3.0);
    EXPECT_NEAR(mean.upper, 3.0 + 2.776 * std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(mean.lower, 3.0 - 2.776 * std::sqrt(0.5), 1e-12);
    EXPECT_TRUE(std::isinf(student_mean({1}).upper));
    EXPECT_TRUE(std::isnan(student_mean({}).value));
    // R: qt(0.975, 40) = 2.021075, qt(0.975, 1e6) = 1.959966.
    EXPECT_NEAR(student_t(40), 2.021075, 1e-4);
    EXPECT_NEAR(student_t(1000000), 1.959966, 1e-5);
}

TEST(ErrorSeries, IsTheMeanOfItsMembersWeighedByTheirValues) {
    ErrorSeries series(SeriesOf::frames);
    const auto first = series.add(with_plane(1.0f), truth_of(0.5f, 0.75f), "ao", 64);  // 0.5 * 0.25
    ASSERT_TRUE(first);
    EXPECT_DOUBLE_EQ(first->mse, 0.125);
    EXPECT_DOUBLE_EQ(series.add(with_plane(1.0f), truth_of(0.5f, 0.25f), "ao", 32)->mse, 0.375);
    EXPECT_DOUBLE_EQ(series.error().mse, 0.25);
    // Over squares of the references, 0.625 and 0.375, and 0.01.
    EXPECT_NEAR(series.error().relative_mse[1].value, 0.5 * (0.125 / 0.400625 + 0.375 / 0.150625), 1e-12);
    EXPECT_LT(series.error().relative_mse[1].lower, series.error().relative_mse[1].value);
    EXPECT_DOUBLE_EQ(series.error().reference_noise_mse, 0.25 * 0.25 / 4);
    EXPECT_EQ(series.error().reference_samples, 32) << "the least of all frames";
    EXPECT_EQ(series.members(), 2u);
    EXPECT_DOUBLE_EQ(series.over_members().value, 0.25);
    EXPECT_NEAR(series.over_members().upper, 0.25 + 12.706 * 0.125, 1e-12) << "two values: 0.125 to either side";

    Image mask(side, side, 1);
    EXPECT_FALSE(series.add(with_plane(9.0f), truth_of(0, 0), "ao", 64, &mask)) << "nothing counts";
    mask.at(3, 3) = 1.0f;
    EXPECT_DOUBLE_EQ(series.add(with_plane(1.0f), truth_of(0, 0), "ao", 64, &mask)->mse, 1.0);
    EXPECT_DOUBLE_EQ(series.error().mse, (0.5 * side * side + 1.0) / (2.0 * side * side + 1.0));
    EXPECT_THROW(ErrorSeries(SeriesOf::seeds).error(), ImageError) << "no member";
}

TEST(ErrorSeries, PairsHalvesWhereTheImageHasThem) {
    Frame method = with_plane(5.0f);
    method.set("half_a.ao", Image(side, side, 1, 1.0f));
    method.set("half_b.ao", Image(side, side, 1, 2.0f));
    ErrorSeries series(SeriesOf::frames);
    EXPECT_DOUBLE_EQ(series.add(method, truth_of(0.5f, 1.75f), "ao", 64)->mse, 0.125);
    EXPECT_DOUBLE_EQ(referenced_error(method, truth_of(0.5f, 1.75f), "ao", 64).mse, 0.125) << "one frame alone too";
}

TEST(ErrorSeries, OverSeedsBothIntervalsHoldTheExpectedError) {
    // A method whose error has a part that all seeds share (a tilt over the image) and noise of its own that is as
    // large in a seed everywhere: its mean square is 0.01 + E[level^2].
    constexpr int draws = 200, seeds = 16;
    std::mt19937 random(12);
    std::normal_distribution<float> normal;
    int covered = 0, covered_by_student = 0;
    for (int draw = 0; draw < draws; ++draw) {
        ReferencedErrorSettings settings;
        settings.bootstrap.resamples = 200;
        ErrorSeries series(SeriesOf::seeds, settings);
        for (int seed = 0; seed < seeds; ++seed) {
            Frame method = with_plane(0.0f);
            const float level = 0.1f * (1.0f + 0.3f * normal(random));
            for (float& value : method.plane("ao").values()) value = level * normal(random);
            const float a = 0.02f * normal(random), b = 0.02f * normal(random);
            series.add(method, truth_of(a, b), "ao", 16);
        }
        const double expected = 0.01 * 1.09;
        const ReferencedError error = series.error();
        covered += error.lower <= expected && expected <= error.upper;
        const Estimate student = series.over_members();
        covered_by_student += student.lower <= expected && expected <= student.upper;
    }
    // 16 skewed members: a bootstrap's interval is narrow by the share that Student's t of 15 degrees (2.13) is above
    // 1.96, some 4 % of coverage, and skew costs both; 200 draws have a standard error of 2 %.
    EXPECT_GE(covered, 0.83 * draws);
    EXPECT_GE(covered_by_student, 0.88 * draws);
    EXPECT_LE(covered_by_student, 0.99 * draws);
}

}  // namespace
}  // namespace plumb

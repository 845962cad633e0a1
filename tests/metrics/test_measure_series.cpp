#include <cmath>

#include <gmock/gmock.h>

#include "frames/image_error.h"
#include "metrics/plane_series.h"

namespace plumb {
namespace {

using testing::SizeIs;

constexpr int width = 16, height = 12;
constexpr double float32 = 1e-6;  // rounding of values near 1

// Grey, the left half brighter by `step`.
Frame picture(float grey, float step = 0.0f) {
    Frame frame(width, height);
    Image ao(width, height, 1, grey);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width / 2; ++x) ao.at(x, y) += step;
    }
    frame.set("ao", ao);
    return frame;
}

Frame truth() {
    Frame frame = picture(0.5f);
    frame.set("half_a.ao", Image(width, height, 1, 0.5f));
    frame.set("half_b.ao", Image(width, height, 1, 0.5f));
    frame.facts["samples"] = "64";
    return frame;
}

Region left_half() {
    Region region{"border", Image(width, height, 1), 0};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width / 2; ++x) region.mask.at(x, y) = 1.0f, ++region.pixels;
    }
    return region;
}

double named(const PlaneSeriesResult& result, std::string_view name) {
    for (const auto& [known, value] : result.measures) {
        if (known == name) return value;
    }
    throw std::out_of_range(std::string(name));
}

TEST(PlaneSeries, PoolsFramesOverTheWholeImageAndOverRegions) {
    PlaneSeries series("ao", SeriesOf::frames, {});
    // Errors of 0.1 and 0.3 on the left, of 0 and 0.2 on the right.
    series.add(picture(0.5f, 0.1f), truth(), {left_half()});
    series.add(picture(0.7f, 0.1f), truth(), {left_half()});
    const auto results = series.results();
    ASSERT_THAT(results, SizeIs(2));
    const PlaneSeriesResult &whole = results[0], &left = results[1];
    EXPECT_NEAR(named(whole, "mae"), 0.15, float32);
    EXPECT_NEAR(named(whole, "mse"), 0.035, float32);
    EXPECT_NEAR(named(whole, "rmse"), std::sqrt(0.035), float32);
    EXPECT_NEAR(named(whole, "psnr"), -10 * std::log10(0.035), 1e-4);
    EXPECT_NEAR(named(whole, "maximum"), 0.3, float32);
    EXPECT_EQ(named(whole, "values"), 2.0 * width * height);
    EXPECT_NEAR(named(whole, "unbiased_mse"), 0.035, float32);
    EXPECT_NEAR(named(whole, "unbiased_psnr"), -10 * std::log10(0.035), 1e-4);
    EXPECT_NEAR(named(whole, "unbiased_relative_mse_pbrt"), 0.035 / (0.51 * 0.51), 1e-5);
    EXPECT_EQ(named(whole, "trustworthy"), 1.0);
    EXPECT_EQ(left.region, "border");
    EXPECT_EQ(left.pixels, 2u * width / 2 * height);
    EXPECT_NEAR(named(left, "mae"), 0.2, float32);
    EXPECT_NEAR(named(left, "unbiased_mse"), 0.05, float32);
    EXPECT_NEAR(named(left, "median"), 0.2, float32) << "mean of the frames' medians";
}

TEST(PlaneSeries, IntervalsCoverWhatChangesFromMemberToMember) {
    PlaneSeries series("ao", SeriesOf::seeds, {});
    for (const float error : {0.1f, 0.2f, 0.3f, 0.4f}) series.add(picture(0.5f + error), truth());
    const PlaneSeriesResult whole = series.results().front();
    // Each image is the same all over: intervals are those of four members drawn with replacement. Their mean is 0.25
    // with a standard deviation of sqrt(0.0125 / 4) = 0.056; it is a multiple of 0.025.
    EXPECT_NEAR(named(whole, "mae"), 0.25, float32);
    EXPECT_NEAR(named(whole, "mae_lower"), 0.25 - 1.96 * 0.056, 0.03);
    EXPECT_NEAR(named(whole, "mae_upper"), 0.25 + 1.96 * 0.056, 0.03);
    for (const std::string name : {"median", "p95", "p99"}) {
        EXPECT_NEAR(named(whole, name), 0.25, float32);
        EXPECT_NEAR(named(whole, name + "_lower"), 0.25 - 1.96 * 0.056, 0.03) << name;
        EXPECT_NEAR(named(whole, name + "_upper"), 0.25 + 1.96 * 0.056, 0.03) << name;
    }
    EXPECT_NEAR(named(whole, "rmse"), std::sqrt(0.075), float32);
    EXPECT_LT(named(whole, "rmse_lower"), named(whole, "rmse"));
    EXPECT_LT(named(whole, "psnr_lower"), -10 * std::log10(0.075));
    EXPECT_GT(named(whole, "psnr_upper"), -10 * std::log10(0.075));
    for (const auto& [name, estimate] : whole.over_members) {
        if (name != "mae") continue;
        // Student's t of 3 degrees: 3.182 sqrt(0.05 / 3 / 4).
        EXPECT_NEAR(estimate.upper - estimate.value, 3.182 * std::sqrt(0.05 / 12), 1e-4);
    }
}

TEST(PlaneSeries, OfOneMemberHasTheIntervalsOfThatImage) {
    Frame test = picture(0.5f);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) test.plane("ao").at(x, y) += 0.01f * static_cast<float>((x * 7 + y * 5) % 13);
    }
    PlaneSeries series("ao", SeriesOf::frames, {});
    const auto single = series.add(test, truth()).front().measures();
    const auto of_series = series.results().front().measures;
    ASSERT_EQ(single.size(), of_series.size());
    for (std::size_t i = 0; i < single.size(); ++i) {
        EXPECT_EQ(single[i].first, of_series[i].first);
        if (std::isfinite(single[i].second)) {
            EXPECT_NEAR(single[i].second, of_series[i].second, 1e-9 * std::abs(single[i].second)) << single[i].first;
        }
    }
}

TEST(PlaneSeries, KeepsTheSizeOfItsFirstFrame) {
    PlaneSeries series("ao", SeriesOf::frames, {});
    series.add(picture(0.5f), truth());
    Frame small(64, 64);
    small.set("ao", Image(64, 64, 1));
    EXPECT_THROW(series.add(small, small), ImageError);
}

}  // namespace
}  // namespace plumb

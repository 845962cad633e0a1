#include "experiments/row_measurement.h"

#include <cmath>

#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr int width = 48, height = 40;

// Black and without noise.
Frame black_truth() {
    Frame frame(width, height);
    for (const char* plane : {"ao", "half_a.ao", "half_b.ao"}) frame.set(plane, Image(width, height, 1));
    return frame;
}

Image grey(float value) { return Image(width, height, 1, value); }

// The left half of the view.
Region left_half() {
    Region region{"border", Image(width, height, 1)};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width / 2; ++x) region.mask.at(x, y) = 1.0f;
    }
    region.pixels = static_cast<std::size_t>(width / 2) * height;
    return region;
}

TEST(RowMeasurement, OfSeedsIsTheMeanWithStudentsIntervalOverThem) {
    const Frame frame = black_truth();
    const Truth truth{"full", "ao", &frame, 64};
    PlaneImage image{"front", "ao", "one", grey(0.1f)};
    image.other_seeds = {grey(0.2f), grey(0.3f)};
    // In the left half the last seed's picture is right.
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width / 2; ++x) image.other_seeds[1].at(x, y) = 0.0f;
    }
    const ResultRow row = measure_row(image, truth, {left_half()}, {});
    EXPECT_EQ(row.seeds, 3);
    EXPECT_TRUE(row.measured);
    // Squares 0.01, 0.04 and half of 0.09; 1e-7: floats' rounding.
    constexpr double a = 0.01, b = 0.04, c = 0.045, mean = (a + b + c) / 3.0;
    EXPECT_NEAR(row.mse, mean, 1e-7);
    EXPECT_NEAR(measure_named(row.measures, "rmse"), std::sqrt(mean), 1e-6);
    const double deviation =
        std::sqrt(((a - mean) * (a - mean) + (b - mean) * (b - mean) + (c - mean) * (c - mean)) / 2.0);
    // Student's t with two degrees of freedom, 97.5 %: 4.303 in the tables, which have three decimals.
    const double half_width = 4.303 * deviation / std::sqrt(3.0);
    EXPECT_NEAR(row.seeds_mse_lower, mean - half_width, 1e-6);
    EXPECT_NEAR(row.seeds_mse_upper, mean + half_width, 1e-6);
    EXPECT_LT(row.mse_lower, mean);
    EXPECT_GT(row.mse_upper, mean);
    ASSERT_EQ(row.regions.size(), 1u);
    EXPECT_NEAR(row.regions[0].mse, (a + b) / 3.0, 1e-7);
    EXPECT_EQ(row.regions[0].pixels, static_cast<std::size_t>(width / 2) * height);
}

TEST(RowMeasurement, OfOnePictureHasNoIntervalOverSeeds) {
    const Frame frame = black_truth();
    const Truth truth{"full", "ao", &frame, 64};
    const ResultRow row = measure_row({"front", "ao", "one", grey(0.2f)}, truth, {left_half()}, {});
    EXPECT_EQ(row.seeds, 1);
    EXPECT_TRUE(std::isnan(row.seeds_mse_lower) && std::isnan(row.seeds_mse_upper));
    EXPECT_NEAR(row.mse, 0.04, 1e-7);
    EXPECT_NEAR(row.mse_lower, 0.04, 1e-7) << "the error is the same everywhere";
}

TEST(RowMeasurement, TellsEveryMeasureWithItsIntervalOverTheViewAndOverRegions) {
    const Frame frame = black_truth();
    const Truth truth{"full", "ao", &frame, 64};
    PlaneImage image{"front", "ao", "one", grey(0.2f)};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width / 2; ++x) image.image.at(x, y) = 0.0125f * static_cast<float>(y);
    }
    ComparisonSettings settings;
    settings.flip = FlipRange::by_plane;
    const ResultRow row = measure_row(image, truth, {left_half()}, settings);
    ASSERT_EQ(row.regions.size(), 1u);
    for (const char* name : {"mae", "bias", "p95", "p99", "ssim", "flip"}) {
        for (const auto* measures : {&row.measures, &row.regions[0].measures}) {
            EXPECT_LE(measure_named(*measures, std::string(name) + "_lower"), measure_named(*measures, name)) << name;
            EXPECT_GE(measure_named(*measures, std::string(name) + "_upper"), measure_named(*measures, name)) << name;
        }
    }
    // 0.0125 times the mean of 0 to 39.
    EXPECT_NEAR(measure_named(row.regions[0].measures, "mae"), 0.0125 * 19.5, 1e-6);
    EXPECT_NE(measure_named(row.regions[0].measures, "flip"), measure_named(row.measures, "flip"));
    EXPECT_TRUE(std::isnan(measure_named(measure_row(image, truth, {}, {}).measures, "flip"))) << "switched off";
}

TEST(RowMeasurement, OfAPlaneOfTheGbufferSaysHowRightItIs) {
    Frame frame(width, height);
    frame.set("depth", grey(2.0f));
    frame.set("normal", Image(width, height, 3, 1.0f));
    const ResultRow depth = measure_row({"front", "depth", "one", grey(2.02f)}, {"", "depth", &frame, 1}, {}, {});
    EXPECT_NEAR(measure_named(depth.fidelity, "depth_error_mean"), 0.01, 1e-6);
    EXPECT_EQ(measure_named(depth.fidelity, "hit_agreement"), 1.0);
    EXPECT_EQ(measure_named(depth.fidelity, "agreement"), 0.0);
    PlaneImage tilted{"front", "normal", "one", Image(width, height, 3, 1.0f)};
    for (int x = 0; x < width; ++x) tilted.image.at(x, 0, 2) = -2.0f;  // at right angles to (1, 1, 1)
    const ResultRow normal = measure_row(tilted, {"", "normal", &frame, 1}, {}, {});
    EXPECT_NEAR(measure_named(normal.fidelity, "normal_angle_mean"), 90.0 / height, 1e-4);
    EXPECT_TRUE(std::isnan(measure_named(normal.fidelity, "hit_agreement"))) << "normals do not tell of surfaces";
    const Frame light = black_truth();
    EXPECT_TRUE(measure_row({"front", "ao", "one", grey(0.2f)}, {"full", "ao", &light, 1}, {}, {}).fidelity.empty());
}

}  // namespace
}  // namespace plumb

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
    const ResultRow row = measure_row(image, truth, {left_half()}, 0.1);
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
    const ResultRow row = measure_row({"front", "ao", "one", grey(0.2f)}, truth, {left_half()}, 0.1);
    EXPECT_EQ(row.seeds, 1);
    EXPECT_TRUE(std::isnan(row.seeds_mse_lower) && std::isnan(row.seeds_mse_upper));
    EXPECT_NEAR(row.mse, 0.04, 1e-7);
    EXPECT_NEAR(row.mse_lower, 0.04, 1e-7) << "the error is the same everywhere";
}

}  // namespace
}  // namespace plumb

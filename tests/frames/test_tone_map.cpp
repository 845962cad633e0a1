#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frames/image_error.h"
#include "frames/picture.h"
#include "frames/tone_map.h"

namespace plumb {
namespace {

TEST(ToneMap, CurvesHaveTheValuesOfTheirFormulas) {
    EXPECT_EQ(apply_tone_curve(ToneCurve::linear, 0.3f), 0.3f);
    EXPECT_EQ(apply_tone_curve(ToneCurve::linear, 7.0f), 7.0f);
    // x = 1: 2.54 / 3.16; x = 0.18: 0.18 (0.4518 + 0.03) / (0.18 (0.4374 + 0.59) + 0.14). By hand, to six digits.
    EXPECT_NEAR(apply_tone_curve(ToneCurve::aces, 1.0f), 0.803797f, 1e-6f);
    EXPECT_NEAR(apply_tone_curve(ToneCurve::aces, 0.18f), 0.266898f, 2e-6f);
    // h(2) = (2 (0.3 + 0.05) + 0.004) / (2 (0.3 + 0.5) + 0.06) - 1/15 = 0.704 / 1.66 - 0.0666667 = 0.357430;
    // h(11.2) = (11.2 (1.68 + 0.05) + 0.004) / (11.2 (1.68 + 0.5) + 0.06) - 1/15 = 19.38 / 24.476 - 0.0666667 =
    // 0.725129.
    EXPECT_NEAR(apply_tone_curve(ToneCurve::filmic, 1.0f), 0.357430f / 0.725129f, 2e-6f);
    EXPECT_NEAR(apply_tone_curve(ToneCurve::filmic, 5.6f), 1.0f, 1e-6f) << "the white that the curve is made for";
}

TEST(ToneMap, CurvesStartAtBlackRiseAndEndAtWhite) {
    for (const ToneCurve curve : {ToneCurve::filmic, ToneCurve::aces}) {
        EXPECT_NEAR(apply_tone_curve(curve, 0.0f), 0.0f, 1e-7f);
        float before = -1e-6f;
        for (float x = 0.0f; x < 30.0f; x += 0.01f) {
            const float now = apply_tone_curve(curve, x);
            ASSERT_GE(now, before) << to_string(curve) << " at " << x;
            before = now;
        }
        EXPECT_EQ(apply_tone_curve(curve, 1e30f), 1.0f);
    }
}

TEST(ToneMap, NamesAreReadAsTheyArePrinted) {
    for (const ToneCurve curve : {ToneCurve::linear, ToneCurve::filmic, ToneCurve::aces}) {
        EXPECT_EQ(tone_curve_from_string(to_string(curve)), curve);
    }
    EXPECT_THROW(tone_curve_from_string("reinhard"), ImageError);
}

TEST(ToneMap, BloomSpreadsLightAndAddsNone) {
    Image image(128, 64, 3);
    image.at(65, 30, 1) = 100.0f;
    const Image bloomed = with_bloom(image, 0.4f);
    double sum = 0.0;
    for (const float value : bloomed.values()) sum += value;
    // Sides are multiples of 64, so that every level's squares tile the image; away from the border bilinear weights
    // sum to 1, at the border they are cut on one side and doubled on the other.
    EXPECT_NEAR(sum, 100.0, 2.0);
    EXPECT_GT(bloomed.at(75, 30, 1), bloomed.at(95, 30, 1));
    EXPECT_GT(bloomed.at(95, 30, 1), 0.0f);
    EXPECT_EQ(bloomed.at(65, 30, 0), 0.0f);
}

// The mean over squares of 2, 4... 64 pixels, each read bilinearly between the squares' centres, from the formula.
TEST(ToneMap, BloomIsTheMeanOfTheSquaresReadBilinearly) {
    constexpr int width = 128, height = 64;  // which squares of every size tile
    Image image(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) image.at(x, y) = static_cast<float>((x * 37 + y * 101) % 64) * 0.25f;
    }
    image.at(65, 30) = 100.0f;
    const auto square = [&](int column, int row, int side) {
        double sum = 0.0;
        for (int y = row * side; y < (row + 1) * side; ++y) {
            for (int x = column * side; x < (column + 1) * side; ++x) sum += image.at(x, y);
        }
        return sum / (side * side);
    };
    constexpr double strength = 0.4;
    const Image bloomed = with_bloom(image, static_cast<float>(strength));
    for (int y = 0; y < height; y += 3) {
        for (int x = 0; x < width; x += 3) {
            double blurred = 0.0;
            for (int side = 2; side <= 64; side *= 2) {
                const double u = (x + 0.5) / side - 0.5, v = (y + 0.5) / side - 0.5;
                const int column = static_cast<int>(std::floor(u)), row = static_cast<int>(std::floor(v));
                for (int j = 0; j < 2; ++j) {
                    for (int i = 0; i < 2; ++i) {
                        const double weight = (1.0 - std::abs(u - column - i)) * (1.0 - std::abs(v - row - j));
                        blurred += weight / 6.0 *
                                   square(std::clamp(column + i, 0, width / side - 1),
                                          std::clamp(row + j, 0, height / side - 1), side);
                    }
                }
            }
            // Float means of values up to 100.
            ASSERT_NEAR(bloomed.at(x, y), (1.0 - strength) * image.at(x, y) + strength * blurred, 1e-5 * 100.0)
                << x << ", " << y;
        }
    }
}

TEST(ToneMap, BloomLeavesConstantsAndWhatIsNotFiniteAsTheyAre) {
    Image image(37, 21, 3, 0.75f);
    const Image constant = with_bloom(image, 1.0f);
    for (const float value : constant.values()) ASSERT_NEAR(value, 0.75f, 1e-6f);
    image.at(5, 6, 2) = std::numeric_limits<float>::infinity();
    image.at(7, 6, 0) = std::numeric_limits<float>::quiet_NaN();
    const Image bloomed = with_bloom(image, 0.5f);
    EXPECT_TRUE(std::isinf(bloomed.at(5, 6, 2)));
    EXPECT_TRUE(std::isnan(bloomed.at(7, 6, 0)));
    EXPECT_TRUE(std::isfinite(bloomed.at(6, 6, 0)));
    EXPECT_THROW(with_bloom(image, 1.5f), ImageError);
    EXPECT_THROW(with_bloom(image, -0.1f), ImageError);
}

// 0.5 stops up, bloomed, then the curve, then sRGB: of a constant, by hand.
TEST(ToneMap, PicturesOfRadianceGoThroughExposureBloomAndCurve) {
    const Image radiance(8, 8, 3, 0.2f);
    const Image picture =
        picture_of_plane("total", radiance, {.exposure = 0.5f, .tone_curve = ToneCurve::aces, .bloom = 0.3f});
    const double exposed = 0.2 * std::sqrt(2.0);
    const double toned = exposed * (2.51 * exposed + 0.03) / (exposed * (2.43 * exposed + 0.59) + 0.14);
    EXPECT_NEAR(picture.at(3, 4, 1), 1.055 * std::pow(toned, 1.0 / 2.4) - 0.055, 1e-5);
    // What is no radiance is not toned.
    const Image ao(8, 8, 1, 0.2f);
    EXPECT_EQ(picture_of_plane("ao", ao, {.tone_curve = ToneCurve::aces}).at(0, 0), 0.2f);
}

}  // namespace
}  // namespace plumb

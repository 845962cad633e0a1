#include <cmath>
#include <limits>
#include <random>

#include <glm/glm.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frames/image_error.h"
#include "metrics/flip.h"

namespace plumb {
namespace {

Image constant(const glm::vec3& colour, int size = 64) {
    Image image(size, size, 3);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            for (int c = 0; c < 3; ++c) image.at(x, y, c) = colour[c];
        }
    }
    return image;
}

Image noise(int width, int height, unsigned seed, float brightest = 1.0f, int channels = 3) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0.0f, brightest);
    Image image(width, height, channels);
    for (float& value : image.values()) value = uniform(random);
    return image;
}

// The paper's formulas once more, in double precision and without any separation of the filters: an independent
// counterpart for one pixel. Matrices are those of IEC 61966-2-1 to seven digits, the white point their sum.
namespace counterpart {

using glm::dvec3;

const dvec3 row_x(0.4123866, 0.3575915, 0.1804505), row_y(0.2126368, 0.7151830, 0.0721802),
    row_z(0.0193306, 0.1191972, 0.9503726);
const dvec3 white(glm::dot(row_x, dvec3(1)), glm::dot(row_y, dvec3(1)), glm::dot(row_z, dvec3(1)));

dvec3 xyz(const dvec3& rgb) { return dvec3(glm::dot(row_x, rgb), glm::dot(row_y, rgb), glm::dot(row_z, rgb)) / white; }
dvec3 opponent(const dvec3& rgb) {
    const dvec3 t = xyz(rgb);
    return {116 * t.y - 16, 500 * (t.x - t.y), 200 * (t.y - t.z)};
}
dvec3 rgb(const dvec3& opponent) {
    const double y = (opponent.x + 16) / 116;
    const dvec3 t = dvec3(y + opponent.y / 500, y, y - opponent.z / 200) * white;
    // Columns of the matrix whose rows stand above.
    const glm::dmat3 m(row_x.x, row_y.x, row_z.x, row_x.y, row_y.y, row_z.y, row_x.z, row_y.z, row_z.z);
    return glm::inverse(m) * t;
}
dvec3 hunt_lab(const dvec3& rgb) {
    const auto f = [](double t) {
        const double d = 6.0 / 29.0;
        return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29.0;
    };
    const dvec3 t = xyz(rgb);
    const double lightness = 116 * f(t.y) - 16;
    return {lightness, 0.01 * lightness * 500 * (f(t.x) - f(t.y)), 0.01 * lightness * 200 * (f(t.y) - f(t.z))};
}
double power_of_hyab(const dvec3& a, const dvec3& b) {
    const dvec3 d = hunt_lab(a) - hunt_lab(b);
    return std::pow(std::abs(d.x) + std::hypot(d.y, d.z), 0.7);
}

dvec3 pixel(const Image& image, int x, int y) {
    const auto p = image.pixel(std::clamp(x, 0, image.width() - 1), std::clamp(y, 0, image.height() - 1));
    return glm::clamp(dvec3(p[0], p[image.channels() == 1 ? 0 : 1], p[image.channels() == 1 ? 0 : 2]), 0.0, 1.0);
}

dvec3 seen(const Image& image, int x, int y, double ppd) {
    const double pi = std::acos(-1.0);
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    const auto term = [&](double a, double b, double square) {
        return a * std::sqrt(pi / b) * std::exp(-pi * pi * square / b);
    };
    dvec3 sum(0), weights(0);
    for (int dy = -radius; dy <= radius; ++dy) {
        for (int dx = -radius; dx <= radius; ++dx) {
            const double square = (dx * dx + dy * dy) / (ppd * ppd);
            const dvec3 weight(term(1, 0.0047, square), term(1, 0.0053, square),
                               term(34.1, 0.04, square) + term(13.5, 0.025, square));
            sum += weight * opponent(pixel(image, x + dx, y + dy));
            weights += weight;
        }
    }
    return glm::clamp(rgb(sum / weights), 0.0, 1.0);
}

// Lengths of the responses of the edge and the point filter.
glm::dvec2 features(const Image& image, int x, int y, double ppd) {
    const double sigma = 0.5 * 0.082 * ppd;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    const auto response = [&](bool point, bool vertical) {
        double above = 0, below = 0, above_sum = 0, below_sum = 0;
        for (int dy = -radius; dy <= radius; ++dy) {
            for (int dx = -radius; dx <= radius; ++dx) {
                const double along = vertical ? dy : dx, g = std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
                const double weight = point ? (along * along / (sigma * sigma) - 1) * g : -along * g;
                const double lightness = (opponent(pixel(image, x + dx, y + dy)).x + 16) / 116;
                (weight > 0 ? above_sum : below_sum) += std::abs(weight);
                (weight > 0 ? above : below) += weight * lightness;
            }
        }
        return above / above_sum + below / below_sum;
    };
    return {std::hypot(response(false, false), response(false, true)),
            std::hypot(response(true, false), response(true, true))};
}

double flip(const Image& test, const Image& reference, int x, int y, double ppd) {
    const double largest = power_of_hyab({0, 1, 0}, {0, 0, 1}), bend = 0.4 * largest;
    double colour = power_of_hyab(seen(test, x, y, ppd), seen(reference, x, y, ppd));
    colour = colour < bend ? 0.95 / bend * colour : 0.95 + (colour - bend) / (largest - bend) * 0.05;
    const glm::dvec2 difference = glm::abs(features(test, x, y, ppd) - features(reference, x, y, ppd));
    const double feature = std::sqrt(std::max(difference.x, difference.y) / std::sqrt(2.0));
    return std::pow(colour, 1 - feature);
}

}  // namespace counterpart

TEST(Flip, ConstantImagesHaveTheValuesOfTheAuthorsProgram) {
    // The means that their tool prints for 64x64 images. It adds single-precision values in single precision, which
    // loses 4e-5 of either mean; done so, ours have its digits.
    constexpr double digits = 5e-7;
    const auto mean_in_single_precision = [](const Image& flip) {
        float sum = 0.0f;
        for (const float value : flip.values()) sum += value;
        return sum / static_cast<float>(flip.values().size());
    };
    const Image black_white = ldr_flip(constant({0, 0, 0}), constant({1, 1, 1})),
                red_green = ldr_flip(constant({1, 0, 0}), constant({0, 1, 0}));
    EXPECT_NEAR(mean_in_single_precision(black_white), 0.967345, digits);
    EXPECT_NEAR(mean_in_single_precision(red_green), 0.986630, digits);
    // What the formula gives, with float's rounding through a slope of CIELAB of 900 near black.
    EXPECT_NEAR(mean_flip(black_white), counterpart::flip(constant({0, 0, 0}), constant({1, 1, 1}), 0, 0, 67.0), 1e-5);
    EXPECT_NEAR(mean_flip(red_green), counterpart::flip(constant({1, 0, 0}), constant({0, 1, 0}), 0, 0, 67.0), 1e-5);
}

TEST(Flip, AgreesWithItsFormulaAtEveryPixel) {
    // Smaller than a block, larger than one, narrower than the filters; grey as well.
    struct Case {
        int width, height, channels;
        double pixels_per_degree;
    };
    for (const Case& c : {Case{19, 13, 3, 67.0}, Case{7, 83, 3, 20.0}, Case{15, 9, 1, 31.5}}) {
        const Image test = noise(c.width, c.height, 1, 1.2f, c.channels),
                    reference = noise(c.width, c.height, 2, 1.2f, c.channels);
        const Image map = ldr_flip(test, reference, c.pixels_per_degree);
        for (int y = 0; y < c.height; ++y) {
            for (int x = 0; x < c.width; ++x) {
                // Single precision through a cube root, whose slope is below 8, and sums of 400 terms; the feature's
                // square root is steep at 0, where noise of this size does not come.
                ASSERT_NEAR(map.at(x, y), counterpart::flip(test, reference, x, y, c.pixels_per_degree), 1e-4)
                    << x << ", " << y << " of " << c.width << "x" << c.height;
            }
        }
    }
}

TEST(Flip, EqualImagesDoNotDifferAndTheOrderDoesNotMatter) {
    const Image a = noise(40, 30, 3), b = noise(40, 30, 4);
    EXPECT_EQ(mean_flip(ldr_flip(a, a)), 0.0);
    EXPECT_EQ(mean_flip(ldr_flip(a, b)), mean_flip(ldr_flip(b, a)));
    EXPECT_GT(mean_flip(ldr_flip(a, b)), 0.1);
}

TEST(Flip, RadianceIsComparedAtEachExposureAndTheWorstOneCounts) {
    const Image test = noise(24, 20, 5, 8.0f), reference = noise(24, 20, 6, 8.0f);
    const ExposureRange range{-3.0, 1.0, 3};
    const Image map = hdr_flip(test, reference, range);
    // ACES as the paper prints it: the fit of K. Narkowicz with an exposure of 0.6.
    const auto shown = [](const Image& image, double stops) {
        Image result = image;
        for (float& value : result.values()) {
            const double x = 0.6 * std::exp2(stops) * value;
            value = static_cast<float>(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14));
        }
        return result;
    };
    Image worst(24, 20, 1);
    for (const double stops : {-3.0, -1.0, 1.0}) {
        const Image flip = ldr_flip(shown(test, stops), shown(reference, stops));
        for (std::size_t i = 0; i < flip.values().size(); ++i)
            worst.values()[i] = std::max(worst.values()[i], flip.values()[i]);
    }
    // The tone-mapped values differ in rounding.
    for (std::size_t i = 0; i < worst.values().size(); ++i)
        ASSERT_NEAR(map.values()[i], worst.values()[i], 1e-4) << "pixel " << i;
    // The authors' program was not at hand to print values of radiance. What stands in for it is the counterpart above,
    // at every exposure.
    for (int i = 0; i < 20; ++i) {
        double largest = 0;
        for (const double stops : {-3.0, -1.0, 1.0})
            largest = std::max(
                largest, counterpart::flip(shown(test, stops), shown(reference, stops), i, i, flip_pixels_per_degree));
        ASSERT_NEAR(map.at(i, i), largest, 1e-4) << "pixel " << i;
    }
}

TEST(Flip, TheExposureRangeFollowsFromTheReferenceAlone) {
    // Values 0.25, 0.5 ... 4, a ninth each from dark to bright, all grey: luminance is the value.
    Image reference(3, 3, 1);
    for (int i = 0; i < 9; ++i) reference.values()[i] = 0.25f * std::exp2(0.5f * static_cast<float>(i));
    const ExposureRange range = exposure_range(reference);
    // From the brightest, 4, to the median, 1: two stops apart, whatever the tone mapper's white is.
    EXPECT_NEAR(range.last - range.first, 2.0, 1e-6);
    EXPECT_EQ(range.count, 2);
    // At the first exposure the brightest pixel is shown at 0.85.
    const double x = 0.6 * 4.0 * std::exp2(range.first);
    EXPECT_NEAR(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.85, 1e-6);
}

TEST(Flip, BlackReferencesDoNotBreakTheExposureRange) {
    Image mostly_black(10, 10, 3);
    for (int c = 0; c < 3; ++c) mostly_black.at(3, 3, c) = 2.0f, mostly_black.at(4, 3, c) = 0.5f;
    const ExposureRange range = exposure_range(mostly_black);
    EXPECT_TRUE(std::isfinite(range.first) && std::isfinite(range.last));
    EXPECT_GE(range.last, range.first);
    try {
        exposure_range(Image(10, 10, 3));
        FAIL() << "a black reference has no exposure";
    } catch (const ImageError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("state a range"));
    }
}

TEST(Flip, PixelsThatAreNotFiniteAreLeftOut) {
    Image test = noise(30, 30, 7), reference = noise(30, 30, 8);
    test.at(12, 9, 1) = std::numeric_limits<float>::quiet_NaN();
    reference.at(20, 21, 0) = std::numeric_limits<float>::infinity();
    const Image map = ldr_flip(test, reference);
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 30; ++x) {
            const bool left_out = (x == 12 && y == 9) || (x == 20 && y == 21);
            EXPECT_EQ(std::isnan(map.at(x, y)), left_out) << x << ", " << y;
        }
    }
    EXPECT_TRUE(std::isfinite(mean_flip(map)));
    Image mask(30, 30, 1);
    mask.at(12, 9) = 1.0f;
    EXPECT_TRUE(std::isnan(mean_flip(map, &mask)));
    mask.at(5, 5) = 1.0f;
    EXPECT_EQ(mean_flip(map, &mask), map.at(5, 5));
}

TEST(Flip, WhatCannotBeComparedIsRefused) {
    EXPECT_THROW(ldr_flip(noise(8, 8, 1), noise(8, 9, 1)), ImageError);
    EXPECT_THROW(ldr_flip(noise(8, 8, 1, 1.0f, 2), noise(8, 8, 1, 1.0f, 2)), ImageError);
    EXPECT_THROW(ldr_flip(noise(8, 8, 1), noise(8, 8, 1), 0.0), ImageError);
    EXPECT_THROW(hdr_flip(noise(8, 8, 1), noise(8, 8, 1), {0.0, 1.0, 0}), ImageError);
}

}  // namespace
}  // namespace plumb

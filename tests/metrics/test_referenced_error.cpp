#include <array>
#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "frames/image_error.h"
#include "metrics/referenced_error.h"

namespace plumb {
namespace {

constexpr int width = 64, height = 64;

float truth_at(int x, int y) {
    return 1.0f + 0.5f * std::sin(0.21f * static_cast<float>(x)) * std::cos(0.13f * static_cast<float>(y));
}

struct Draw {
    Image test{width, height, 1}, half_a{width, height, 1}, half_b{width, height, 1};
};

// A truth, a method with a random error, and a reference whose halves have the given noise.
Draw make_draw(std::mt19937& random, float error_sigma, float half_sigma) {
    std::normal_distribution<float> normal;
    Draw draw;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float truth = truth_at(x, y);
            draw.test.at(x, y) = truth + error_sigma * normal(random);
            draw.half_a.at(x, y) = truth + half_sigma * normal(random);
            draw.half_b.at(x, y) = truth + half_sigma * normal(random);
        }
    }
    return draw;
}

TEST(ReferencedError, MatchesTwoPixelsComputedByHand) {
    Image test(2, 1, 1), a(2, 1, 1), b(2, 1, 1);
    test.at(0, 0) = 1.0f, a.at(0, 0) = 0.5f, b.at(0, 0) = 0.75f;  // (I-A)(I-B) = 0.125, plain 0.140625, noise 0.015625
    test.at(1, 0) = 2.0f, a.at(1, 0) = 1.0f, b.at(1, 0) = 3.0f;   // -1, 0, 1
    const ReferencedError error = referenced_error(test, a, b, 100);
    EXPECT_DOUBLE_EQ(error.mse, -0.4375);
    EXPECT_DOUBLE_EQ(error.plain_mse, 0.0703125);
    EXPECT_DOUBLE_EQ(error.reference_noise_mse, 0.5078125);
    EXPECT_DOUBLE_EQ(error.mse, error.plain_mse - error.reference_noise_mse);
    EXPECT_FALSE(error.trustworthy);
    // The references are 0.625 and 2.
    EXPECT_NEAR(error.relative_mse[0].value, 0.5 * (0.125 / (0.635 * 0.635) - 1.0 / (2.01 * 2.01)), 1e-12);
    EXPECT_NEAR(error.relative_mse[1].value, 0.5 * (0.125 / (0.390625 + 0.01) - 1.0 / 4.01), 1e-12);
    EXPECT_NEAR(error.relative_mse[2].value, 0.5 * (0.125 / (0.390625 + 0.001) - 1.0 / 4.001), 1e-12);
    EXPECT_NEAR(error.relative_mse[1].lower, -1.0 / 4.01, 1e-9) << "two blocks: either may be drawn twice";
    EXPECT_NEAR(error.relative_mse[1].upper, 0.125 / 0.400625, 1e-9);
}

TEST(ReferencedError, RelativeErrorsAreFreeOfTheNoiseToo) {
    // Error 0.05, noise of each half 0.03, of their mean 0.021: plain relative errors are 18 % too large.
    constexpr int draws = 300;
    constexpr double error = 0.05, noise = 0.03 * 0.03 / 2;
    std::array<double, relative_mses.size()> sums{}, squares{}, answers{};
    double plain = 0.0;  // by tev's definition
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (std::size_t i = 0; i < answers.size(); ++i)
                answers[i] += error * error / relative_mses[i].weight(truth_at(x, y)) / (width * height);
        }
    }
    std::mt19937 random(13);
    ReferencedErrorSettings quick;
    quick.bootstrap.resamples = 40;  // the interval is not looked at here
    for (int draw = 0; draw < draws; ++draw) {
        const Draw one = make_draw(random, static_cast<float>(error), 0.03f);
        const ReferencedError found = referenced_error(one.test, one.half_a, one.half_b, 16, quick);
        for (std::size_t i = 0; i < answers.size(); ++i) {
            sums[i] += found.relative_mse[i].value;
            squares[i] += found.relative_mse[i].value * found.relative_mse[i].value;
        }
        Image mean(width, height, 1);
        for (std::size_t i = 0; i < mean.values().size(); ++i)
            mean.values()[i] = 0.5f * (one.half_a.values()[i] + one.half_b.values()[i]);
        plain += pixel_errors(one.test, mean, 1.0).relative_mse_tev / draws;
    }
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const double mean = sums[i] / draws;
        const double standard_error = std::sqrt((squares[i] / draws - mean * mean) / (draws - 1));
        EXPECT_LT(standard_error, 0.005 * answers[i]) << "otherwise the test proves nothing";
        // What the denominator's noise leaves where the truth is darkest, 0.5: 3 s^2 / r^2 = 0.54 %.
        EXPECT_NEAR(mean, answers[i], 0.0054 * answers[i] + 4 * standard_error) << relative_mses[i].name;
    }
    EXPECT_GT(plain, (1.0 + 0.9 * noise / (error * error)) * answers[1]);
}

TEST(ReferencedError, IsFreeOfTheNoiseThatThePlainErrorHas) {
    // Error 0.02 (MSE 4e-4), noise of each half 0.1: the mean of both has variance 5e-3, more than ten times the error.
    constexpr double true_mse = 0.02 * 0.02, noise = 0.1 * 0.1 / 2;
    constexpr int draws = 300;
    std::mt19937 random(11);
    double sum = 0, squares = 0, plain = 0, noise_sum = 0;
    ReferencedErrorSettings quick;
    quick.bootstrap.resamples = 40;  // the interval is not looked at here
    for (int i = 0; i < draws; ++i) {
        const Draw draw = make_draw(random, 0.02f, 0.1f);
        const ReferencedError error = referenced_error(draw.test, draw.half_a, draw.half_b, 16, quick);
        sum += error.mse;
        squares += error.mse * error.mse;
        plain += error.plain_mse;
        noise_sum += error.reference_noise_mse;
    }
    const double mean = sum / draws;
    const double standard_error = std::sqrt((squares / draws - mean * mean) / (draws - 1));
    // Four standard errors: a correct estimator fails once in 16000 seeds.
    EXPECT_NEAR(mean, true_mse, 4 * standard_error) << "standard error " << standard_error;
    EXPECT_LT(standard_error, 0.05 * true_mse) << "otherwise the test above proves nothing";
    EXPECT_NEAR(noise_sum / draws, noise, 0.01 * noise) << "300 x 4096 pixels: 0.13 % standard error";
    EXPECT_NEAR(plain / draws, true_mse + noise, 0.01 * noise) << "the plain error counts the noise";
    EXPECT_GT(plain / draws, 10 * true_mse);
}

TEST(ReferencedError, IntervalCoversTheTrueErrorInAboutNinetyFivePercentOfDraws) {
    constexpr int draws = 400;
    std::mt19937 random(5);
    int covered = 0;
    for (int i = 0; i < draws; ++i) {
        const Draw draw = make_draw(random, 0.05f, 0.03f);
        const ReferencedError error = referenced_error(draw.test, draw.half_a, draw.half_b, 16);
        ASSERT_LE(error.lower, error.mse);
        ASSERT_GE(error.upper, error.mse);
        covered += error.lower <= 0.05 * 0.05 && 0.05 * 0.05 <= error.upper;
    }
    // 64 blocks make percentile intervals slightly narrow (about 94 %); 400 draws have a standard error of 1.2 %.
    EXPECT_GE(covered, 0.90 * draws);
    EXPECT_LE(covered, 0.99 * draws);
}

TEST(ReferencedError, BlocksKeepTheIntervalHonestWhereErrorsOfNeighboursAreAlike) {
    // An error constant over 8x8 pixels, as a blur leaves it. Drawing single pixels would give an interval eight times
    // too narrow; blocks of 8 (64 of them fit) keep the coverage.
    constexpr int draws = 300;
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    int covered_by_blocks = 0, covered_by_pixels = 0;
    ReferencedErrorSettings pixels;
    pixels.bootstrap.block_size = 1;
    pixels.bootstrap.resamples = 100;
    for (int i = 0; i < draws; ++i) {
        Draw draw = make_draw(random, 0.0f, 0.01f);
        for (int by = 0; by < height; by += 8) {
            for (int bx = 0; bx < width; bx += 8) {
                const float error = 0.1f * normal(random);
                for (int y = by; y < by + 8; ++y) {
                    for (int x = bx; x < bx + 8; ++x) draw.test.at(x, y) += error;
                }
            }
        }
        const auto blocks = referenced_error(draw.test, draw.half_a, draw.half_b, 16);
        const auto single = referenced_error(draw.test, draw.half_a, draw.half_b, 16, pixels);
        EXPECT_EQ(blocks.block_size, 8);
        covered_by_blocks += blocks.lower <= 0.01 && 0.01 <= blocks.upper;
        covered_by_pixels += single.lower <= 0.01 && 0.01 <= single.upper;
    }
    // 64 independent squares of a normal variable are skewed, which costs a percentile interval some coverage: 88 %.
    EXPECT_GE(covered_by_blocks, 0.88 * draws);
    EXPECT_LT(covered_by_pixels, 0.4 * draws);
}

TEST(ReferencedError, IsTheSameOnEveryRun) {
    std::mt19937 random(1);
    const Draw draw = make_draw(random, 0.05f, 0.03f);
    const auto first = referenced_error(draw.test, draw.half_a, draw.half_b, 16);
    const auto second = referenced_error(draw.test, draw.half_a, draw.half_b, 16);
    EXPECT_EQ(first.lower, second.lower);
    EXPECT_EQ(first.upper, second.upper);
}

TEST(ReferencedError, IsNotTrustedWhereTheNoiseIsNearTheErrorAndSaysHowManySamplesWouldDo) {
    std::mt19937 random(2);
    // Noise variance of the mean 0.05^2 / 2 = 0.00125, error 0.0025: half of it. A tenth takes five times the samples.
    const Draw noisy = make_draw(random, 0.05f, 0.05f);
    const auto error = referenced_error(noisy.test, noisy.half_a, noisy.half_b, 64);
    EXPECT_FALSE(error.trustworthy);
    EXPECT_NEAR(error.ratio, 0.5, 0.05) << "4096 pixels: about 4 % standard error";
    ASSERT_TRUE(error.samples_needed());
    EXPECT_NEAR(static_cast<double>(*error.samples_needed()), 5 * 64, 32);
    EXPECT_EQ(*error.samples_needed() % 2, 0) << "two halves";

    const Draw clean = make_draw(random, 0.05f, 0.01f);
    const auto trusted = referenced_error(clean.test, clean.half_a, clean.half_b, 64);
    EXPECT_TRUE(trusted.trustworthy) << trusted.ratio;
    EXPECT_LE(*trusted.samples_needed(), 64);
    EXPECT_FALSE(referenced_error(clean.test, clean.half_a, clean.half_b, 0).samples_needed()) << "samples unknown";
}

TEST(ReferencedError, EqualNoiselessImagesAreTrusted) {
    const Image image(20, 20, 3, 0.5f);
    const auto error = referenced_error(image, image, image, 8);
    EXPECT_EQ(error.mse, 0.0);
    EXPECT_EQ(error.ratio, 0.0);
    EXPECT_TRUE(error.trustworthy);
}

TEST(ReferencedError, LeavesOutAndCountsValuesThatAreNotFiniteAndMaskedPixels) {
    Image test(4, 1, 1, 1.0f), half(4, 1, 1, 0.5f), mask(4, 1, 1, 1.0f);
    test.at(0, 0) = NAN;
    test.at(3, 0) = 100.0f;
    mask.at(3, 0) = 0.0f;
    ReferencedErrorSettings settings;
    settings.mask = &mask;
    const auto error = referenced_error(test, half, half, 8, settings);
    EXPECT_DOUBLE_EQ(error.mse, 0.25);
    EXPECT_EQ(error.left_out, 1u);
    EXPECT_THROW(referenced_error(test, half, Image(4, 2, 1), 8), ImageError);
}

TEST(ReferencedError, OfFramesNamesThePlaneThatIsMissing) {
    Frame method(1, 1), reference(1, 1);
    method.set("direct", Image(1, 1, 3));
    reference.set("half_a.direct", Image(1, 1, 3));
    try {
        referenced_error(method, reference, "direct", 8);
        FAIL() << "no ImageError";
    } catch (const ImageError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("half_b.direct"));
    }
}

}  // namespace
}  // namespace plumb

#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "frames/image_error.h"
#include "metrics/path_stability.h"
#include "tests/metrics/panned_wall.h"

namespace plumb {
namespace {

using namespace test;

// Errors of about 0.1 to 1 stored in single precision and squared.
constexpr double float32 = 1e-6;

// The wall with a truth of two halves.
Frame truth_with_halves(double camera, const std::function<double(double)>& half_a,
                        const std::function<double(double)>& half_b) {
    Frame frame = wall(camera, [&](double s) { return 0.5 * (half_a(s) + half_b(s)); });
    frame.set("half_a.direct", wall(camera, half_a).plane("direct"));
    frame.set("half_b.direct", wall(camera, half_b).plane("direct"));
    return frame;
}

TEST(PathStability, AnErrorThatGrowsByTheSameEveryFrameHasTheFlickerAndVarianceOfTheFormula) {
    PathStability stability("direct");
    for (int t = 0; t < 12; ++t) {
        const double grown = 0.125 * t;
        const auto flicker = stability.add(wall(0, [&](double s) { return texture(s) + grown; }), wall(0, texture));
        EXPECT_EQ(flicker.has_value(), t > 0);
        EXPECT_NEAR(flicker ? flicker->rms : 0.125, 0.125, float32) << "frame " << t;
    }
    const PathStabilityResult result = stability.result();
    EXPECT_EQ(result.frames, 12u);
    EXPECT_NEAR(result.flicker.value, 0.125, float32);
    EXPECT_NEAR(result.flicker.lower, 0.125, float32) << "the same everywhere and always";
    EXPECT_NEAR(result.flicker.upper, 0.125, float32);
    EXPECT_NEAR(result.method_warping.value, 0.125, float32);
    EXPECT_NEAR(result.truth_warping.value, 0.0, float32);
    // 0..7 have variance 42 / 7 = 6.
    EXPECT_NEAR(result.temporal_variance.value, 6 * 0.125 * 0.125, float32);
    EXPECT_TRUE(result.trustworthy) << "a truth without noise";
    EXPECT_EQ(result.pixels, 11u * wall_width * wall_height);
}

TEST(PathStability, FollowsSurfacePointsOverManyFramesByFractionsOfPixels) {
    for (const double pan : {0.25, -0.5, 1.0, 0.0}) {
        const auto wrong = [](double s) { return texture(s) + 0.1 * s; };  // an error that sticks to the wall
        PathStability stability("direct");
        for (int t = 0; t < 8; ++t) stability.add(wall(t * pan, wrong), with_motion(wall(t * pan, texture), pan));
        const PathStabilityResult result = stability.result();
        EXPECT_NEAR(result.flicker.value, 0.0, 2 * float32) << "pan by " << pan << ": bilinear look-ups of ramps";
        EXPECT_NEAR(result.temporal_variance.value, 0.0, float32) << "pan by " << pan;

        // The same error stuck to the screen slides over the wall by its slope times the pan each frame.
        PathStability sliding("direct");
        for (int t = 0; t < 8; ++t) {
            const auto stuck = [&](double s) { return texture(s) + 0.1 * (s - t * pan); };
            sliding.add(wall(t * pan, stuck), with_motion(wall(t * pan, texture), pan));
        }
        EXPECT_NEAR(sliding.result().flicker.value, std::abs(0.1 * pan), 2 * float32) << "pan by " << pan;
        EXPECT_NEAR(sliding.result().temporal_variance.value, 6 * 0.01 * pan * pan, 4 * float32) << "pan by " << pan;
    }
}

TEST(PathStability, TemporalVarianceLeavesOutPointsThatWereHiddenInAnyFrameOfTheWindow) {
    PathStabilitySettings settings;
    settings.window = 4;
    PathStability stability("direct", settings);
    for (int t = 0; t < 4; ++t) {
        // Column 5 errs more and more, but a post stood there in frame 1.
        Frame method = wall(0, texture), truth = wall(0, texture);
        for (int y = 0; y < wall_height; ++y) {
            method.plane("direct").at(5, y) += 0.25f * static_cast<float>(t);
            if (t == 1) truth.plane("position").at(5, y, 2) = -1.0f;
        }
        stability.add(method, truth);
    }
    EXPECT_EQ(stability.result().temporal_variance.value, 0.0);
    EXPECT_EQ(stability.result().not_visible, 2u * wall_height) << "when the post came and when it went";
    EXPECT_GT(stability.result().flicker.value, 0.0) << "from frame 2 to frame 3 it was visible";
}

TEST(PathStability, OfAMaskCountsItsPixelsAlone) {
    PathStability stability("direct");
    Image mask(wall_width, wall_height, 1);
    for (int x = 4; x < 8; ++x) mask.at(x, 3) = 1.0f;
    for (int t = 0; t < 3; ++t) {
        Frame method = wall(0, texture);
        for (int x = 4; x < 8; ++x) method.plane("direct").at(x, 3) += 0.5f * static_cast<float>(t);
        stability.add(method, wall(0, texture), &mask);
    }
    EXPECT_NEAR(stability.result().flicker.value, 0.5, float32);
    EXPECT_EQ(stability.result().pixels, 2u * 4);
}

TEST(PathStability, OfRegionsIsThatOfEachPixelsOwnFrame) {
    PathStability stability("direct");
    for (int t = 0; t < 8; ++t) {
        Region upper{"border", Image(wall_width, wall_height, 1)};
        for (int x = 0; x < wall_width; ++x) upper.mask.at(x, 0) = 1.0f;
        upper.pixels = wall_width;
        Region lower{"silhouettes", Image(wall_width, wall_height, 1)};
        for (int x = 0; x < wall_width; ++x) lower.mask.at(x, wall_height - 1) = 1.0f;
        lower.pixels = wall_width;
        // Grows by 0.25 a frame in the first row, and stays as wrong as it is in the last.
        Frame method = wall(0, texture);
        for (int x = 0; x < wall_width; ++x) {
            method.plane("direct").at(x, 0) += 0.25f * static_cast<float>(t);
            method.plane("direct").at(x, wall_height - 1) += 0.5f;
        }
        // A region may be missing in some frames.
        stability.add(method, wall(0, texture), nullptr,
                      t < 6 ? std::vector<Region>{upper, lower} : std::vector<Region>{upper});
    }
    const auto regions = stability.of_regions();
    ASSERT_EQ(regions.size(), 2u);
    EXPECT_NEAR(regions.at("border").flicker.value, 0.25, float32);
    EXPECT_EQ(regions.at("border").pixels, 7 * std::size_t{wall_width});
    // Of what grows by d a frame over 8 frames: 6 d^2.
    EXPECT_NEAR(regions.at("border").temporal_variance.value, 6.0 * 0.0625, 1e-5);
    EXPECT_NEAR(regions.at("silhouettes").flicker.value, 0.0, float32);
    EXPECT_EQ(regions.at("silhouettes").pixels, 5 * std::size_t{wall_width});
    EXPECT_TRUE(std::isnan(regions.at("silhouettes").temporal_variance.value))
        << "it was not there in the eighth frame";
    // One row of so many flickers.
    EXPECT_NEAR(stability.result().flicker.value, 0.25 / std::sqrt(wall_height), 1e-5);
}

TEST(PathStability, IsNotBiasedByTheNoiseOfATruthInHalves) {
    // Noise in time of variance 0.05^2 in the method; noise of 0.2 in each half, which makes the truth's mean flicker
    // by 0.2 sqrt(2 / 2) = 0.2, thrice as much as the method does.
    constexpr double error = 0.05, noise = 0.2;
    constexpr int frames = 400;
    std::mt19937 random(6);
    std::normal_distribution<double> normal;
    const auto noisy = [&](double sigma) {
        return [&, sigma](double s) { return texture(s) + sigma * normal(random); };
    };
    PathStability stability("direct");
    for (int t = 0; t < frames; ++t)
        stability.add(wall(0, noisy(error)), truth_with_halves(0, noisy(noise), noisy(noise)));
    const PathStabilityResult result = stability.result();
    // The intervals hold what theory says; fixed seed, and the intervals are narrow enough to prove something.
    EXPECT_LE(result.flicker.lower, error * std::sqrt(2.0));
    EXPECT_GE(result.flicker.upper, error * std::sqrt(2.0));
    EXPECT_LT(result.flicker.upper - result.flicker.lower, 0.5 * error);
    EXPECT_LE(result.temporal_variance.lower, error * error);
    EXPECT_GE(result.temporal_variance.upper, error * error);
    EXPECT_LT(result.temporal_variance.upper, 2 * error * error);
    EXPECT_LT(result.truth_warping.lower, 0.02) << "the truth stands still";
    // 400 frames of 128 pixels: 0.4 % standard error.
    EXPECT_NEAR(result.noise, noise, 0.02 * noise);
    EXPECT_NEAR(result.method_warping.value, error * std::sqrt(2.0), 0.02 * error);
    EXPECT_FALSE(result.trustworthy) << "the noise is nine times what it should be";
}

TEST(PathStability, OfAPathTooShortSaysNothing) {
    PathStability stability("direct");
    EXPECT_TRUE(std::isnan(stability.result().flicker.value));
    stability.add(wall(0, texture), wall(0, texture));
    EXPECT_TRUE(std::isnan(stability.result().flicker.value));
    stability.add(wall(0, texture), wall(0, texture));
    EXPECT_EQ(stability.result().flicker.value, 0.0);
    EXPECT_TRUE(std::isnan(stability.result().temporal_variance.value)) << "two frames of eight";
    EXPECT_THROW(PathStability("direct", {.flicker = {}, .window = 1}), ImageError);
    Frame bare(wall_width, wall_height);
    bare.set("direct", Image(wall_width, wall_height, 1));
    EXPECT_THROW(stability.add(bare, bare), ImageError);
}

TEST(FlickerOfHalves, IntervalHoldsTheTrueFlickerInMostDraws) {
    constexpr double error = 0.1, noise = 0.05;
    constexpr int draws = 200;
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    const auto noisy = [&](double sigma) {
        return [&, sigma](double s) { return texture(s) + sigma * normal(random); };
    };
    int covered = 0;
    for (int draw = 0; draw < draws; ++draw) {
        const Flicker result =
            flicker(wall(0, noisy(error)), truth_with_halves(0, noisy(noise), noisy(noise)), wall(0, noisy(error)),
                    truth_with_halves(0, noisy(noise), noisy(noise)), "direct");
        covered += result.rms_lower <= error * std::sqrt(2.0) && error * std::sqrt(2.0) <= result.rms_upper;
    }
    // 128 single pixels, whose squares are skewed: about 93 %; 200 draws have a standard error of 1.8 %.
    EXPECT_GE(covered, 0.87 * draws);
    EXPECT_LE(covered, 0.99 * draws);
}

}  // namespace
}  // namespace plumb

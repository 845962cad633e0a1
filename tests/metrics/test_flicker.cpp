#include <cmath>
#include <limits>
#include <tuple>

#include <gmock/gmock.h>

#include "frames/image_error.h"
#include "metrics/flicker.h"
#include "tests/metrics/panned_wall.h"

namespace plumb {
namespace {

using namespace test;

constexpr int width = wall_width, height = wall_height;
constexpr double float32 = 1e-6;  // values of about 1, stored in single precision

TEST(Flicker, OfAnErrorThatStaysIsZeroAndOfOneThatChangesSignIsTwiceTheError) {
    const Frame truth = wall(0, texture);
    const Frame brighter = wall(0, [](double s) { return texture(s) + 0.25; });
    const Frame darker = wall(0, [](double s) { return texture(s) - 0.25; });
    EXPECT_NEAR(flicker(brighter, truth, brighter, truth, "direct").rms, 0.0, float32);
    const Flicker changing = flicker(brighter, truth, darker, truth, "direct");
    EXPECT_NEAR(changing.rms, 0.5, float32);
    EXPECT_NEAR(changing.method_warping, 0.5, float32);
    EXPECT_NEAR(changing.truth_warping, 0.0, float32);
    EXPECT_EQ(changing.pixels, static_cast<std::size_t>(width * height));
}

TEST(Flicker, OfAMethodInHalvesIsThatOfEachHalfAgainstTheTruthsOwn) {
    // Halves a and b of the truth gain 1 and 2 from frame to frame, those of the method 3 and 5: errors gain 2 and 3.
    const auto in_halves = [](float a, float b) {
        Frame frame = wall(0, texture);
        const Image base = frame.plane("direct");
        for (const auto& [name, offset] : {std::pair{"half_a.direct", a}, {"half_b.direct", b}}) {
            Image half = base;
            for (float& value : half.values()) value += offset;
            frame.set(name, half);
        }
        return frame;
    };
    const Flicker result = flicker(in_halves(0, 0), in_halves(0, 0), in_halves(3, 5), in_halves(1, 2), "direct");
    EXPECT_NEAR(result.rms, std::sqrt(2.0 * 3.0), 4 * float32);
    EXPECT_NEAR(result.method_warping, std::sqrt(3.0 * 5.0), 4 * float32);
    EXPECT_NEAR(result.truth_warping, std::sqrt(1.0 * 2.0), 4 * float32);
    EXPECT_NEAR(result.noise, 0.5 * (3.0 - 2.0), 4 * float32);
}

// NumPy 1.24.2 and SciPy 1.10.1 (Debian 12):
//
//   import numpy as np
//   from scipy.ndimage import map_coordinates
//   f = np.float32
//   y, x = np.mgrid[0:8, 0:16].astype(float)
//   truth = lambda s: 0.5 + 0.03 * s
//   m0, t0 = f(truth(x) + 0.2 * np.sin(0.9 * x)), f(truth(x))
//   m1, t1 = f(truth(x + pan) + 0.25 * np.cos(0.7 * (x + pan))), f(truth(x + pan))
//   warp = lambda a: map_coordinates(a.astype(float), [y, x + pan], order=1)
//   rms = lambda a: np.sqrt((a[x + pan <= 15]**2).mean())
//   rms(f(m1 - t1) - warp(f(m0 - t0))), rms(m1 - warp(m0))
TEST(Flicker, MatchesAWarpByNumPyAndSciPy) {
    for (const auto& [pan, rms, warping, pixels] : {std::tuple{1.5, 0.12848046278024405, 0.12848046538469718, 112u},
                                                    {0.25, 0.13035493943368476, 0.1303549331618762, 120u}}) {
        const Frame before = wall(0, [](double s) { return texture(s) + 0.2 * std::sin(0.9 * s); }),
                    now = wall(pan, [](double s) { return texture(s) + 0.25 * std::cos(0.7 * s); });
        const Flicker result =
            flicker(before, wall(0, texture), with_motion(now, pan), with_motion(wall(pan, texture), pan), "direct");
        EXPECT_NEAR(result.rms, rms, float32) << pan;
        EXPECT_NEAR(result.method_warping, warping, float32) << pan;
        EXPECT_EQ(result.pixels, pixels) << pan;
    }
}

TEST(Flicker, WhatTheTruthItselfDoesCancels) {
    const auto bright = [](double s) { return 2 * texture(s); };
    const Flicker result = flicker(wall(0, texture), wall(0, texture), wall(0, bright), wall(0, bright), "direct");
    EXPECT_NEAR(result.rms, 0.0, float32);
    EXPECT_GT(result.truth_warping, 0.4);
    EXPECT_DOUBLE_EQ(result.truth_warping, result.method_warping);
}

TEST(Flicker, FollowsSurfacePointsThroughMotionByWholeAndByFractionsOfPixels) {
    for (const double pan : {3.0, -2.0, 1.5, 0.25}) {
        const auto wrong = [](double s) { return texture(s) + 0.1 * s; };  // an error that sticks to the wall
        const Flicker result =
            flicker(wall(0, wrong), wall(0, texture), wall(pan, wrong), with_motion(wall(pan, texture), pan), "direct");
        EXPECT_NEAR(result.rms, 0.0, 2 * float32) << "pan by " << pan << ": bilinear look-ups are exact on ramps";
        const auto outside = static_cast<std::size_t>(std::ceil(std::abs(pan))) * height;
        EXPECT_EQ(result.not_visible, outside) << "pan by " << pan;
        EXPECT_EQ(result.pixels, std::size_t{width} * height - outside) << "pan by " << pan;
    }
}

TEST(Flicker, OfAnErrorThatSticksToTheScreenIsItsSlopeTimesTheMotion) {
    const double pan = 3;
    const auto before = [](double s) { return texture(s) + 0.1 * s; };
    const auto now = [&](double s) { return texture(s) + 0.1 * (s - pan); };
    const Flicker result =
        flicker(wall(0, before), wall(0, texture), wall(pan, now), with_motion(wall(pan, texture), pan), "direct");
    EXPECT_NEAR(result.rms, 0.3, float32);
}

TEST(Flicker, FollowsSurfacesWhosePixelsAreFarApart) {
    // The wall's pixels are 0.01 m wide; of one only 0.2 m away, in an image so small, that is five per cent of depth.
    const auto near = [](double camera) {
        Frame frame = wall(camera, texture);
        frame.set("depth", Image(width, height, 1, 0.2f));
        return frame;
    };
    const Flicker result = flicker(near(0), near(0), near(1.5), with_motion(near(1.5), 1.5), "direct");
    EXPECT_EQ(result.not_visible, 2u * height) << "two columns came in over the edge";
    EXPECT_NEAR(result.rms, 0.0, float32);
}

TEST(Flicker, LeavesOutPointsThatWereHiddenBefore) {
    Frame truth_before = wall(0, texture);
    for (int y = 0; y < height; ++y) truth_before.plane("position").at(5, y, 2) = -1.0f;  // a post stood there
    const Frame truth = wall(0, texture);
    const Flicker result = flicker(truth, truth_before, truth, truth, "direct");
    EXPECT_EQ(result.not_visible, static_cast<std::size_t>(height));
}

TEST(Flicker, CountsBackgroundAsNotVisibleAndValuesThatAreNotFinite) {
    Frame truth = wall(0, texture), method = wall(0, texture);
    truth.plane("depth").at(0, 0) = std::numeric_limits<float>::infinity();
    truth.plane("motion").at(1, 0, 0) = std::numeric_limits<float>::infinity();
    truth.plane("motion").at(2, 0, 0) = std::numeric_limits<float>::quiet_NaN();
    method.plane("direct").at(4, 4) = std::numeric_limits<float>::quiet_NaN();
    const Flicker result = flicker(wall(0, texture), wall(0, texture), method, truth, "direct");
    EXPECT_EQ(result.not_visible, 3u);
    EXPECT_EQ(result.non_finite, 1u);
    EXPECT_NEAR(result.rms, 0.0, float32);
}

TEST(Flicker, NamesThePlaneThatIsMissingAndSaysNothingWhereNothingIsVisible) {
    const Frame truth = wall(0, texture);
    Frame bare(width, height);
    bare.set("direct", Image(width, height, 1));
    try {
        flicker(truth, truth, truth, bare, "direct");
        FAIL() << "no ImageError";
    } catch (const ImageError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("motion"));
    }
    EXPECT_TRUE(std::isnan(flicker(truth, truth, truth, with_motion(wall(0, texture), 100), "direct").rms));
}

}  // namespace
}  // namespace plumb

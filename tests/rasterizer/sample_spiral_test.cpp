#include "rasterizer/sample_spiral.h"

#include <cmath>
#include <numeric>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

TEST(SampleSpiral, TurnsAreThoseOfThePublishedTable) {
    EXPECT_EQ(spiral_turns(1), 1);
    EXPECT_EQ(spiral_turns(9), 2);
    EXPECT_EQ(spiral_turns(14), 3);
    EXPECT_EQ(spiral_turns(19), 7);
    EXPECT_EQ(spiral_turns(46), 17);
    EXPECT_EQ(spiral_turns(89), 34);
    EXPECT_EQ(spiral_turns(99), 29);
    EXPECT_EQ(spiral_turns(100), 5779);
    EXPECT_EQ(spiral_turns(1000), 5779);
}

TEST(SampleSpiral, SampleCountsOutOfRangeAreRefusedWithTheRange) {
    for (const int samples : {-1, 0, 1001}) {
        try {
            spiral_turns(samples);
            FAIL() << samples << " samples were accepted";
        } catch (const MethodError& error) {
            EXPECT_NE(std::string(error.what()).find("1 to 1000"), std::string::npos) << error.what();
        }
    }
}

TEST(SampleSpiral, NoTwoTapsOfAPixelShareADirection) {
    for (int samples = 1; samples <= maximum_spiral_samples; ++samples) {
        // i tau mod N takes each of N values once where tau and N have no common factor.
        EXPECT_EQ(std::gcd(samples, spiral_turns(samples)), 1) << samples << " samples";
    }
}

glm::dvec2 stored(std::span<const glm::vec4> table, int index) {
    const glm::vec4& pair = table[static_cast<std::size_t>(index / 2)];
    return index % 2 == 0 ? glm::dvec2(pair.x, pair.y) : glm::dvec2(pair.z, pair.w);
}

TEST(SampleSpiral, TapDirectionsAreUnitVectorsThatLeanNowhere) {
    for (const int samples : {2, 16, 19, 46, 99, 100, 1000}) {
        const SpiralTables tables(samples);
        glm::dvec2 sum(0.0);
        for (int i = 0; i < samples; ++i) {
            const glm::dvec2 direction = stored(tables.tap_directions, i);
            // 1e-7: the rounding of one float.
            EXPECT_NEAR(glm::length(direction), 1.0, 1e-7) << "tap " << i << " of " << samples;
            sum += direction;
        }
        // N directions 1 / N turn apart cancel; up to 1e-7 of rounding each.
        EXPECT_LT(glm::length(sum), 1e-7 * samples) << samples << " samples";
    }
}

TEST(SampleSpiral, TheFirstTurnsOfTheSpiralFollowTheFormula) {
    const SpiralTables tables(19);
    const double quarter = 2.0 * 3.14159265358979 * 7.0 / 19.0;  // tap 1 of 19 at 7 / 19 turns
    EXPECT_NEAR(stored(tables.tap_directions, 0).x, 1.0, 1e-7);
    EXPECT_NEAR(stored(tables.tap_directions, 1).x, std::cos(quarter), 1e-7);
    EXPECT_NEAR(stored(tables.tap_directions, 1).y, std::sin(quarter), 1e-7);
    EXPECT_NEAR(stored(tables.spin_directions, 256).y, 1.0, 1e-7);  // a quarter turn
}

}  // namespace
}  // namespace plumb

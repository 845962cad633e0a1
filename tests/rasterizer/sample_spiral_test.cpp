#include "rasterizer/sample_spiral.h"

#include <cmath>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "rasterizer/gl_error.h"
#include "sample_spiral_counterpart.h"

namespace plumb {
namespace {

TEST(SampleSpiral, TurnsAreThoseOfThePublishedTable) {
    // By rows of ten, from N = 0 on, which nobody can ask for.
    const std::vector<int> published = {
        1,  1,  1,  2,  3,  2,  5,  2,  3,  2,  3,  3,  5,  5,  3,  4,  7,  5,  5,  7,   // 0 to 19
        9,  8,  5,  5,  7,  7,  7,  8,  5,  8,  11, 12, 7,  10, 13, 8,  11, 8,  7,  14,  // 20 to 39
        11, 11, 13, 12, 13, 19, 17, 13, 11, 18, 19, 11, 11, 14, 17, 21, 15, 16, 17, 18,  // 40 to 59
        13, 17, 11, 17, 19, 18, 25, 18, 19, 19, 29, 21, 19, 27, 31, 29, 21, 18, 17, 29,  // 60 to 79
        31, 31, 23, 18, 25, 26, 25, 23, 19, 34, 19, 27, 21, 25, 39, 29, 17, 21, 27, 29   // 80 to 99
    };
    ASSERT_EQ(published.size(), 100u);
    for (int samples = 1; samples < 100; ++samples)
        EXPECT_EQ(spiral_turns(samples), published[static_cast<std::size_t>(samples)]) << samples << " samples";
    for (const int samples : {100, 101, 1000}) EXPECT_EQ(spiral_turns(samples), 5779) << samples << " samples";
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

// The hash that stands for the thesis' random numbers: directions that lean nowhere and that those of neighbours do not
// tell. (That the shader's is the same is for the agreement of the passes to show.)
TEST(SampleSpiral, RandomSpinsAreEvenAndIndependentOfTheirNeighbours) {
    constexpr int side = 256;
    const auto direction = [](int x, int y) {
        const double turns = counterpart::hash_of({x, y}) * 0x1p-32;
        return glm::dvec2(std::cos(2.0 * 3.14159265358979 * turns), std::sin(2.0 * 3.14159265358979 * turns));
    };
    glm::dvec2 mean(0.0), beside(0.0), above(0.0);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const auto turned_back = [&](const glm::dvec2& other) {
                const glm::dvec2 own = direction(x, y);
                return glm::dvec2(glm::dot(own, other), own.x * other.y - own.y * other.x);
            };
            mean += direction(x, y) / (1.0 * side * side);
            beside += turned_back(direction(x + 1, y)) / (1.0 * side * side);
            above += turned_back(direction(x, y + 1)) / (1.0 * side * side);
        }
    }
    // n independent unit vectors have a mean of some 1 / sqrt(n); four times that in 65536.
    for (const glm::dvec2& sum : {mean, beside, above}) EXPECT_LT(glm::length(sum), 4.0 / side);
}

TEST(SampleSpiral, TheThesisStartsItsSpiralAtHalfOverTau) {
    for (const int samples : {11, 23, 37, 100}) {
        EXPECT_NEAR(counterpart::even_jitter(TapPattern::nielsen2015, samples) / 65536.0, 0.5 / spiral_turns(samples),
                    1.0 / 65536.0);
    }
    EXPECT_EQ(counterpart::even_jitter(TapPattern::sao2012, 23), 32768u);
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

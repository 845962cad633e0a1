// The random numbers and the maps from them.
#include <set>

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "pathtracer/direction_sampling.h"
#include "pathtracer/discrete_distribution.h"
#include "pathtracer/environment_distribution.h"
#include "pathtracer/sample_sequence.h"
#include "tests/pathtracer/test_scenes.h"

namespace plumb {
namespace {

// A (0, 2)-sequence: any aligned run of 2^m samples has one point in each of the 2^m boxes of every shape 2^-a x
// 2^-(m-a).
TEST(SampleSequence, HasOnePointInEveryElementaryBox) {
    for (const std::uint32_t dimension : {0u, 3u, 17u}) {
        SampleSequence sequence(7, 12, 34);
        for (const int m : {1, 4, 7, 10}) {
            const int count = 1 << m;
            for (const int first : {0, count, 5 * count}) {
                for (int a = 0; a <= m; ++a) {
                    std::set<std::pair<int, int>> boxes;
                    for (int i = first; i < first + count; ++i) {
                        sequence.start_sample(2 * i);  // half A
                        const glm::vec2 point = sequence.point(dimension);
                        ASSERT_TRUE(point.x >= 0.0f && point.x < 1.0f && point.y >= 0.0f && point.y < 1.0f);
                        boxes.insert({static_cast<int>(point.x * static_cast<float>(1 << a)),
                                      static_cast<int>(point.y * static_cast<float>(1 << (m - a)))});
                    }
                    EXPECT_EQ(static_cast<int>(boxes.size()), count)
                        << "dimension " << dimension << " m " << m << " a " << a;
                }
            }
        }
    }
}

// Pixels, halves, dimensions and seeds must not know of each other: the correlation of n independent uniform numbers is
// normal with deviation 1 / sqrt(n), and 4.5 deviations are passed by chance once in 150 000 pairs.
TEST(SampleSequence, IsUncorrelatedBetweenPixelsHalvesDimensionsAndSeeds) {
    constexpr int count = 20000;
    const auto number = [](std::uint64_t seed, int pixel, int sample, std::uint32_t dimension) {
        SampleSequence sequence(seed, pixel % 200, pixel / 200);
        sequence.start_sample(sample);
        return static_cast<double>(sequence.point(dimension).y) - 0.5;
    };
    const auto correlation = [&](auto&& a, auto&& b) {
        double sum = 0.0;
        for (int i = 0; i < count; ++i) sum += a(i) * b(i);
        return 12.0 * sum / count;
    };
    const double bound = 4.5 / std::sqrt(static_cast<double>(count));
    const auto base = [&](int i) { return number(1, i, 0, 1); };
    EXPECT_NEAR(correlation(base, [&](int i) { return number(1, i + 1, 0, 1); }), 0.0, bound) << "pixels";
    EXPECT_NEAR(correlation(base, [&](int i) { return number(1, i + 200, 0, 1); }), 0.0, bound) << "rows";
    EXPECT_NEAR(correlation(base, [&](int i) { return number(1, i, 1, 1); }), 0.0, bound) << "halves";
    EXPECT_NEAR(correlation(base, [&](int i) { return number(1, i, 0, 2); }), 0.0, bound) << "dimensions";
    EXPECT_NEAR(correlation(base, [&](int i) { return number(2, i, 0, 1); }), 0.0, bound) << "seeds";
    EXPECT_NEAR(correlation(base, [&](int) { return 1.0; }) / 12.0, 0.0, bound) << "mean";
}

// Also about both poles, where the formula changes sign.
TEST(CompleteBasis, IsOrthonormalAndRightHanded) {
    for (const glm::vec3 axis : {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::vec3(1, 0, 0), glm::vec3(1, -2, -3)}) {
        const glm::vec3 normal = glm::normalize(axis);
        glm::vec3 tangent, bitangent;
        complete_basis(normal, tangent, bitangent);
        // 1e-6: a few roundings of float32.
        EXPECT_NEAR(glm::dot(tangent, bitangent), 0.0f, 1e-6f);
        EXPECT_NEAR(glm::length(tangent), 1.0f, 1e-6f);
        EXPECT_NEAR(glm::length(glm::cross(tangent, bitangent) - normal), 0.0f, 1e-6f);
    }
}

TEST(SmallSineCosine, AgreeWithTheLibrary) {
    for (float angle = -glm::quarter_pi<float>(); angle <= glm::quarter_pi<float>(); angle += 1e-3f) {
        float sine, cosine;
        small_sine_cosine(angle, sine, cosine);
        EXPECT_NEAR(sine, std::sin(angle), 1.2e-7f);  // two units in the last place of 1
        EXPECT_NEAR(cosine, std::cos(angle), 1.2e-7f);
    }
}

TEST(DiscreteDistribution, ChoosesByWeightAndNeverAWeightlessItem) {
    const std::vector<double> weights = {0.0, 1.0, 0.0, 3.0, 0.0};
    const DiscreteDistribution distribution(weights);
    EXPECT_EQ(distribution.sample(0.0), 1u);
    EXPECT_EQ(distribution.sample(0.2499), 1u);
    EXPECT_EQ(distribution.sample(0.25), 3u);
    EXPECT_EQ(distribution.sample(1.0), 3u);  // what rounds up to 1 is the last item with a weight
    EXPECT_DOUBLE_EQ(distribution.probability(1), 0.25);
    EXPECT_DOUBLE_EQ(distribution.probability(2), 0.0);
    EXPECT_EQ(distribution.sample(0.25 + 0.75 * 0.5), 3u);
    EXPECT_DOUBLE_EQ(distribution.within(0.25 + 0.75 * 0.5, 3), 0.5);
    EXPECT_TRUE(DiscreteDistribution(std::vector<double>{0.0, 0.0}).empty());
}

TEST(EnvironmentDistribution, DensityIntegratesToOneAndCoversAllRadiance) {
    const Scene scene = sky_scene();
    const EnvironmentDistribution distribution(scene);
    double integral = 0.0;
    constexpr int rows = 800, columns = 1600;
    for (int j = 0; j < rows; ++j) {
        const double theta = glm::pi<double>() * (j + 0.5) / rows;
        for (int i = 0; i < columns; ++i) {
            const double phi = glm::two_pi<double>() * (i + 0.5) / columns;
            const glm::vec3 direction(std::sin(theta) * std::cos(phi), std::cos(theta),
                                      std::sin(theta) * std::sin(phi));
            const double density = distribution.density(direction), value = scene.environment_radiance(direction).y;
            integral += density * std::sin(theta);
            if (value > 1e-4) {
                ASSERT_GT(density, 0.0) << direction.x << " " << direction.y << " " << direction.z;
            }
        }
    }
    const double cell = glm::pi<double>() / rows * glm::two_pi<double>() / columns;
    // The density jumps at texel borders: the grid of 100 cells per texel places those to 1 %, with both signs.
    EXPECT_NEAR(integral * cell, 1.0, 2e-3);
}

TEST(EnvironmentDistribution, SamplesCarryTheDensityOfTheirDirection) {
    const Scene scene = sky_scene();
    const EnvironmentDistribution distribution(scene);
    for (int i = 0; i < 2000; ++i) {
        SampleSequence sequence(5, i, 0);
        sequence.start_sample(0);
        const EnvironmentSample sample = distribution.sample(sequence.point(0));
        const float there = distribution.density(sample.direction);
        // Within 1e-6 of a texel's border rounding may fall on either side; none of these 2000 lies so near.
        EXPECT_NEAR(there, sample.density, 1e-3f * sample.density) << i;
    }
}

}  // namespace
}  // namespace plumb

// Pictures of one view with different seeds: independent noise around one mean.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gl_test.h"
#include "rasterizer/pipeline.h"
#include "rasterizer/sample_spiral.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

using SeedTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(SeedTest);

constexpr int view_width = 64, view_height = 48;

// Few taps and no filter: all noise is left.
Method noisy_method() {
    Method method;
    method.direct.shadow.emitter_size = 64;
    method.ao.samples = method.radiosity.samples = 4;
    method.ao.blur.radius = method.radiosity.blur.radius = 0;
    return method;
}

Method with_traced_lobes() {
    Method method = noisy_method();
    method.reflections.enabled = true;
    method.reflections.roughness = ReflectionRoughness::samples;
    method.reflections.samples = 4;
    return method;
}

Scene metal_cornell() {
    Scene scene = make_cornell();
    for (Material& material : scene.materials) material.metallic = 1.0f, material.roughness = 0.6f;
    return scene;
}

class Renderer {
public:
    Renderer(GlContext& context, Scene scene, const Method& method, std::string plane)
        : scene_(std::move(scene)),
          plane_(std::move(plane)),
          view_(scene_.cameras[0], view_width, view_height),
          pipeline_(context, scene_, method, wanted(plane_), view_width, view_height) {}

    std::vector<float> picture(std::uint32_t seed) {
        const RasterResult result = pipeline_.render({.now = {view_}, .seed = seed});
        const auto values = result.frame.plane(plane_).values();
        return {values.begin(), values.end()};
    }

    void forget() { pipeline_.forget(); }

private:
    static Quantities wanted(const std::string& plane) {
        Quantities quantities;
        quantities.planes = {plane};
        return quantities;
    }

    Scene scene_;
    std::string plane_;
    View view_;
    Pipeline pipeline_;
};

std::vector<double> mean_of_seeds(Renderer& renderer, std::uint32_t first, int count) {
    std::vector<double> sum;
    for (int i = 0; i < count; ++i) {
        const std::vector<float> picture = renderer.picture(first + static_cast<std::uint32_t>(i));
        sum.resize(picture.size());
        for (std::size_t j = 0; j < sum.size(); ++j) sum[j] += picture[j] / count;
    }
    return sum;
}

double mean_squared_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum / static_cast<double>(a.size());
}

TEST_P(SeedTest, ASeedAlwaysGivesTheSameBitsAndAnotherSeedOthers) {
    Renderer renderer(context(), make_cornell(), noisy_method(), "ao");
    const std::vector<float> first = renderer.picture(0), third = renderer.picture(3);
    EXPECT_NE(first, third);
    EXPECT_EQ(renderer.picture(0), first);
    EXPECT_EQ(renderer.picture(3), third);
}

// Independent noise around one mean: the variance of a mean of n pictures is the n-th part, against the mean of m
// others (1/n + 1/m)/(1 + 1/m) of a single one's. Noise that had something in common from seed to seed would stay.
void expect_independence(Renderer& renderer, const std::string& what) {
    constexpr int few = 8, many = 32;
    const std::vector<double> truth = mean_of_seeds(renderer, 1000, many);
    double single = 0.0;
    for (std::uint32_t seed = 0; seed < few; ++seed)
        single += mean_squared_difference(mean_of_seeds(renderer, seed, 1), truth) / few;
    const double of_mean = mean_squared_difference(mean_of_seeds(renderer, 0, few), truth);
    ASSERT_GT(single, 1e-7) << what << ": there is no noise";
    const double expected = (1.0 / few + 1.0 / many) / (1.0 + 1.0 / many);
    // Some 3000 pixels' squares, of which neighbours share some taps: a few hundred independent ones would give the
    // ratio a standard error of 10 %.
    EXPECT_NEAR(of_mean / single, expected, 0.25 * expected) << what;
}

TEST_P(SeedTest, NoiseIsIndependentFromSeedToSeed) {
    Renderer ao(context(), make_cornell(), noisy_method(), "ao");
    expect_independence(ao, "ao");
    Renderer indirect(context(), make_cornell(), noisy_method(), "indirect");
    expect_independence(indirect, "indirect");
    Renderer reflection(context(), metal_cornell(), with_traced_lobes(), "reflection");
    expect_independence(reflection, "reflection");
}

TEST_P(SeedTest, WhatWasRenderedBeforeIsForgotten) {
    Method method = noisy_method();
    method.ao.temporal.alpha = 0.9f;
    Renderer renderer(context(), make_cornell(), method, "ao");
    const std::vector<float> first = renderer.picture(5), second = renderer.picture(5);
    EXPECT_NE(first, second) << "the filter keeps nothing";
    renderer.forget();
    EXPECT_EQ(renderer.picture(5), first);
}

TEST(Seed, MovesPatternsFarAndNotAtAllForZero) {
    EXPECT_EQ(pattern_shift(0), glm::ivec2(0));
    std::vector<glm::ivec2> shifts;
    for (std::uint32_t seed = 0; seed < 256; ++seed) shifts.push_back(pattern_shift(seed));
    for (std::size_t i = 0; i < shifts.size(); ++i) {
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(shifts[i], glm::ivec2(0))) &&
                    glm::all(glm::lessThan(shifts[i], glm::ivec2(1 << 15))));
        for (std::size_t j = 0; j < i; ++j) EXPECT_NE(shifts[i], shifts[j]) << i << " and " << j;
    }
}

}  // namespace
}  // namespace plumb

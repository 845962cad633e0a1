// Both estimators and both ways to spread the taps, against the CPU.
#include <gmock/gmock.h>

#include "gl_test.h"
#include "radiosity_agreement.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/radiosity_gather.h"

namespace plumb {
namespace {

using RadiosityEstimatorsTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(RadiosityEstimatorsTest);

const Quantities gathered = {.planes = {"radiosity"}};
constexpr auto nielsen = RadiosityEstimator::nielsen2015;
constexpr float infinity = std::numeric_limits<float>::infinity();

struct Case {
    const char* name;
    RadiositySettings settings;
};
const std::vector<Case> cases = {
    {"Nielsen's, as in the thesis",
     {.estimator = nielsen, .radius = 5.0f, .spread_pixels = 40, .test_tap_normal = false, .use_mip_chain = false}},
    {"Nielsen's without a cut-off",
     {.estimator = nielsen, .radius = infinity, .spread_pixels = 40, .test_tap_normal = false}},
    {"Nielsen's of one layer", {.estimator = nielsen, .layers = 1, .test_tap_normal = false}},
    {"Nielsen's with tap normals tested", {.estimator = nielsen}},
    {"Nielsen's divided by the samples",
     {.estimator = nielsen, .test_tap_normal = false, .normalisation = RadiosityNormalisation::samples}},
    {"Mara's over fixed pixels", {.radius = 0.5f, .spread_pixels = 25}},
    {"Mara's without a cut-off", {.radius = infinity, .spread_pixels = 25}},
};

TEST_P(RadiosityEstimatorsTest, AgreeWithTheirCounterpartOnNoise) {
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(97, 66), 5);
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        ScreenSpaceRun run(context(), noise, unblurred(c.settings), gathered);
        const Image image = run.render("radiosity", 4);
        EXPECT_LT(expect_agreement(run.layers(), c.settings, image, image), 0.08);
    }
}

TEST_P(RadiosityEstimatorsTest, NielsenCountsBothLayersAndMaraTheStrongerOne) {
    // A floor between two walls: of every tap on them one layer sends, or none, or both.
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(97, 66), 6);
    const auto brightness_per_tap = [&](RadiosityEstimator estimator) {
        RadiositySettings settings{.estimator = estimator, .test_tap_normal = false};
        settings.normalisation = RadiosityNormalisation::samples;
        ScreenSpaceRun run(context(), noise, unblurred(settings), gathered);
        const Image image = run.render("radiosity", 4);
        const double taps = estimator == nielsen ? 2.0 : 1.0;  // Nielsen divides by the taps of both layers
        std::vector<double> sums;
        for (std::size_t i = 0; i < image.values().size(); i += 4) sums.push_back(taps * image.values()[i]);
        return sums;
    };
    const std::vector<double> added = brightness_per_tap(nielsen), stronger = brightness_per_tap({});
    int more = 0;
    for (std::size_t i = 0; i < added.size(); ++i) {
        // The stronger of two vectors may be the weaker in red, but never exceeds their sum.
        ASSERT_LE(stronger[i], added[i] * (1.0 + 1e-5) + 1e-6) << i;
        more += added[i] > stronger[i] * 1.01;
    }
    EXPECT_GT(more, 1000) << "of 97 * 66 pixels";
}

// What the estimators tend to with more and more taps, divided by all of them: an integral over the disc, here a fine
// grid in radius and angle. In alpha the confidence.
glm::dvec4 limit_of(const counterpart::Layers& layers, const RadiositySettings& settings, counterpart::Pixel pixel) {
    constexpr int steps = 200;
    const double radius = layers.view.pixels_per_metre() * settings.radius / counterpart::depth_at(layers, 0, pixel);
    const bool adds = settings.estimator == nielsen;
    glm::dvec3 sum{0.0};
    double hits = 0.0;
    bool ignored = false;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const double distance = radius * (i + 0.5) / steps, angle = 2.0 * std::numbers::pi * (j + 0.5) / steps;
            const counterpart::Pixel tap{pixel.x + static_cast<int>(std::floor(distance * std::cos(angle) + 0.5)),
                                         pixel.y + static_cast<int>(std::floor(distance * std::sin(angle) + 0.5))};
            if (!counterpart::inside(layers, tap)) continue;
            glm::dvec3 best{0.0};
            bool hit = false;
            for (int layer = 0; layer < settings.layers; ++layer) {
                const auto one =
                    counterpart::received_from(layers, settings, Falloff::hard, pixel, tap, layer, {}, ignored);
                if (adds) {
                    sum += one.light, hits += one.hit;
                } else {
                    hit |= one.hit;
                    if (glm::dot(one.light, one.light) > glm::dot(best, best)) best = one.light;
                }
            }
            sum += best;
            hits += hit;
        }
    }
    const double taps = static_cast<double>(steps) * steps * (adds ? settings.layers : 1);
    return {2.0 * std::numbers::pi / taps * sum, hits / taps};
}

// A corner of floor and wall, and a board before the wall, so that both layers hold something.
counterpart::Layers corner() {
    return layers_of_patches(slanted_view(120, 90), {{{-4.0f, -1.0f, -7.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 8.0f}},
                                                     {{-4.0f, -1.0f, -6.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 6.0f, 0.0f}},
                                                     {{-1.0f, -0.6f, -5.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 1.2f, 0.3f}}});
}

TEST_P(RadiosityEstimatorsTest, ConvergeToTheirIntegralOverTheDisc) {
    const counterpart::Layers layers = corner();
    for (const RadiosityEstimator estimator : {RadiosityEstimator::mara2016, nielsen}) {
        SCOPED_TRACE(to_string(estimator));
        // Divided by the hits it would be a quotient of two such integrals, which says nothing where hardly a tap hits.
        RadiositySettings settings{
            .estimator = estimator, .normalisation = RadiosityNormalisation::samples, .use_mip_chain = false};
        const auto pixels = [&](const auto& look_at) {
            for (int y = 5; y < 90; y += 20) {
                for (int x = 5; x < 120; x += 15) {
                    const counterpart::Pixel pixel{x, y};
                    if (counterpart::depth_at(layers, 0, pixel) != 0.0) look_at(pixel);
                }
            }
        };
        std::vector<glm::dvec4> limits;
        pixels([&](counterpart::Pixel pixel) { limits.push_back(limit_of(layers, settings, pixel)); });
        const auto mean_error = [&](int samples, int seeds = 1) {
            settings.samples = samples;
            ScreenSpaceRun run(context(), layers, unblurred(settings), gathered);
            const Image image = mean_over_seeds(run, "radiosity", 4, seeds);
            glm::dvec2 error{0.0}, reference{0.0};
            auto expected = limits.begin();
            pixels([&](counterpart::Pixel pixel) {
                const glm::dvec2 is(image.at(pixel.x, 89 - pixel.y, 0), image.at(pixel.x, 89 - pixel.y, 3));
                error += glm::abs(is - glm::dvec2(expected->x, expected->w));
                reference += glm::dvec2(expected->x, expected->w);
                ++expected;
            });
            EXPECT_GT(reference.x, 0.5) << "of 40 pixels: wall, floor and board light each other";
            return error / reference;
        };
        const glm::dvec2 few = mean_error(16), many = mean_error(1000), thousands = mean_error(1000, 4);
        for (const int i : {0, 1}) {
            SCOPED_TRACE(i == 0 ? "irradiance" : "confidence");
            // N points spread evenly over a disc miss its edges by some N^(-3/4), 0.6 % of 1000, and what sends is a
            // small part of the disc.
            EXPECT_LT(many[i], 0.03) << "relative error of 1000 taps; of 16: " << few[i];
            EXPECT_LT(many[i], few[i] / 5.0) << few[i];
            // What is left is that of the grid, whose cells are half a pixel wide at the disc's edge.
            EXPECT_LT(thousands[i], 0.01) << "relative error of 4 seeds of 1000 taps; of one: " << many[i];
            EXPECT_LT(thousands[i], many[i]);
        }
    }
}

TEST_P(RadiosityEstimatorsTest, ParametersThatCannotBeCombinedAreRefusedWithTheRemedy) {
    const auto error_of = [&](const RadiositySettings& settings) -> std::string {
        try {
            ScreenSpaceRun run(context(), counterpart::random_layers(slanted_view(8, 8), 1), unblurred(settings),
                               gathered);
        } catch (const MethodError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_THAT(error_of({.estimator = nielsen, .radius = infinity}), testing::HasSubstr("radiosity.spread_pixels"));
    EXPECT_THAT(error_of({.spread_pixels = -1}), testing::HasSubstr("radiosity.spread_pixels is -1"));
    EXPECT_THAT(error_of({.radius = std::numeric_limits<float>::quiet_NaN(), .spread_pixels = 20}),
                testing::HasSubstr("radiosity.radius is nan"));
    EXPECT_THAT(error_of({.bounces = 9}), testing::HasSubstr("it can be 1 to 8"));
    EXPECT_THAT(error_of({.bounces = 2, .carry = true}), testing::HasSubstr("set it to 1"));
    EXPECT_THAT(error_of({.saturated_boost = -1.0f}), testing::HasSubstr("radiosity.saturated_boost is -1"));
    EXPECT_THAT(error_of({.fill = AmbientSource::ambient, .ambient = -1.0f}),
                testing::HasSubstr("radiosity.ambient is -1"));
}

}  // namespace
}  // namespace plumb

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
    {"Nielsen's with the thesis' taps",
     {.estimator = nielsen, .samples = 23, .pattern = TapPattern::nielsen2015, .test_tap_normal = false}},
    {"Mara's with the thesis' taps", {.pattern = TapPattern::nielsen2015}},
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
    constexpr int rings = 100, sectors = 200;
    const double radius = layers.view.pixels_per_metre() * settings.radius / counterpart::depth_at(layers, 0, pixel);
    const bool adds = settings.estimator == nielsen;
    glm::dvec3 sum{0.0};
    double hits = 0.0;
    bool ignored = false;
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < sectors; ++j) {
            const double distance = radius * (i + 0.5) / rings, angle = 2.0 * std::numbers::pi * (j + 0.5) / sectors;
            const counterpart::Pixel tap{pixel.x + static_cast<int>(std::floor(distance * std::cos(angle) + 0.5)),
                                         pixel.y + static_cast<int>(std::floor(distance * std::sin(angle) + 0.5))};
            if (!counterpart::inside(layers, tap)) continue;
            glm::dvec3 best{0.0};
            bool hit = false;
            for (int layer = 0; layer < settings.layers; ++layer) {
                const auto one =
                    counterpart::received_from(layers, settings, Falloff::hard, pixel, {tap, tap}, layer, {}, ignored);
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
    const double taps = static_cast<double>(rings) * sectors * (adds ? settings.layers : 1);
    return {2.0 * std::numbers::pi / taps * sum, hits / taps};
}

// Floor, ceiling, walls and end of a corridor, which light each other, with a shelf across it, so that both layers hold
// something.
counterpart::Layers corridor() {
    return layers_of_patches(slanted_view(60, 45), {{{-1.0f, -1.0f, -7.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
                                                    {{-1.0f, 1.0f, -7.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
                                                    {{-1.0f, -1.0f, -7.0f}, {0.0f, 2.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
                                                    {{1.0f, -1.0f, -7.0f}, {0.0f, 2.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
                                                    {{-1.0f, -1.0f, -5.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 2.0f, 0.0f}},
                                                    {{-1.0f, -0.4f, -4.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.1f, 0.8f}}});
}

TEST_P(RadiosityEstimatorsTest, ConvergeToTheirIntegralOverTheDisc) {
    const counterpart::Layers layers = corridor();
    for (const RadiosityEstimator estimator : {RadiosityEstimator::mara2016, nielsen}) {
        RadiositySettings settings{.estimator = estimator, .radius = 2.0f, .use_mip_chain = false};
        std::vector<std::pair<counterpart::Pixel, glm::dvec4>> limits;
        for (int y = 4; y < 45; y += 9) {
            for (int x = 4; x < 60; x += 11) {
                const counterpart::Pixel pixel{x, y};
                if (counterpart::depth_at(layers, 0, pixel) != 0.0)
                    limits.push_back({pixel, limit_of(layers, settings, pixel)});
            }
        }
        for (const RadiosityNormalisation normalisation :
             {RadiosityNormalisation::samples, RadiosityNormalisation::hits}) {
            SCOPED_TRACE(testing::Message() << to_string(estimator) << ", divided by "
                                            << (normalisation == RadiosityNormalisation::hits ? "hits" : "samples"));
            settings.normalisation = normalisation;
            const bool by_hits = normalisation == RadiosityNormalisation::hits;
            const auto mean_error = [&](int samples, int seeds = 1) {
                settings.samples = samples;
                ScreenSpaceRun run(context(), layers, unblurred(settings), gathered);
                const Image image = mean_over_seeds(run, "radiosity", 4, seeds);
                glm::dvec2 error{0.0}, reference{0.0};
                int pixels = 0;
                for (const auto& [pixel, limit] : limits) {
                    // The quotient of two integrals says nothing where hardly a tap hits.
                    if (by_hits && limit.w < 0.1) continue;
                    const glm::dvec2 expected(by_hits ? limit.x / limit.w : limit.x, limit.w);
                    error += glm::abs(
                        glm::dvec2(image.at(pixel.x, 44 - pixel.y, 0), image.at(pixel.x, 44 - pixel.y, 3)) - expected);
                    reference += expected;
                    ++pixels;
                }
                EXPECT_GT(pixels, 10) << "wall, floor and board light each other";
                EXPECT_GT(reference.x, 0.5);
                return error / reference;
            };
            const glm::dvec2 few = mean_error(16), many = mean_error(1000), thousands = mean_error(1000, 4);
            for (const int i : {0, 1}) {
                SCOPED_TRACE(i == 0 ? "irradiance" : "confidence");
                // N points spread evenly over a disc miss its edges by some N^(-3/4), 0.6 % of 1000, and what sends is
                // a small part of the disc.
                EXPECT_LT(many[i], 0.03) << "relative error of 1000 taps; of 16: " << few[i];
                EXPECT_LT(many[i], few[i] / 4.0) << few[i];
                // What is left is that of the grid, whose cells are a fraction of a pixel wide at the disc's edge.
                EXPECT_LT(thousands[i], 0.01) << "relative error of 4 seeds of 1000 taps; of one: " << many[i];
                EXPECT_LT(thousands[i], many[i]);
            }
        }
    }
}

TEST_P(RadiosityEstimatorsTest, SeedsMoveAndFramesTurnTheTapsAsTheFormulaSays) {
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(61, 42), 5);
    for (const bool vary : {true, false}) {
        RadiositySettings settings{.samples = 9};
        settings.temporal = {.alpha = 0.9f, .vary_taps = vary};
        ScreenSpaceRun run(context(), noise, unblurred(settings), {.planes = {"radiosity.of_frame"}});
        for (const auto& [seed, frame] : {std::pair{0u, 1}, std::pair{0u, 13}, std::pair{77u, 2}}) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", frame " << frame << ", varying " << vary);
            const counterpart::SpiralPattern pattern{pattern_shift(seed),
                                                     vary ? static_cast<std::uint32_t>(frame) : 0u};
            const Image image = run.render("radiosity.of_frame", 4, 0, 0, seed, frame);
            EXPECT_LT(expect_agreement(run.layers(), settings, image, image, Falloff::hard, {}, pattern), 0.05);
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

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

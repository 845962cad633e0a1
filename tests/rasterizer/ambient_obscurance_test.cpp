#include "rasterizer/ambient_obscurance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ambient_obscurance_agreement.h"
#include "gl_test.h"
#include "random_views.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/pipeline.h"
#include "rasterizer/scene_reach.h"
#include "scenes/builtin.h"
#include "screen_space_run.h"

namespace plumb {
namespace {

using Estimator = AmbientObscuranceEstimator;
using Case = ObscuranceCase;
using AmbientObscuranceTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(AmbientObscuranceTest);

const std::vector<Case> cases = {
    {"as the paper", {}},
    {"one layer", {.layers = 1}},
    {"without MIP chain", {.use_mip_chain = false}},
    {"one layer without MIP chain", {.layers = 1, .use_mip_chain = false}},
    {"coarse from the first pixel on", {.mip_offset = 0}},
    {"points at the taps", {.mip_offset = 1, .mip_points = MipTapPoint::sao2012}},
    {"the demo's", {.estimator = Estimator::g3d_demo, .intensity = 1.2f}},
    {"SAO", {.estimator = Estimator::sao2012, .intensity = 0.1f}, Falloff::cubic},
    {"SAO, falloff A", {.estimator = Estimator::sao2012, .intensity = 0.1f}, Falloff::hard},
    {"SAO, falloff C", {.estimator = Estimator::sao2012_undivided, .intensity = 0.1f}},
    {"SAO, falloff D", {.estimator = Estimator::sao2012_undivided, .intensity = 0.1f}, Falloff::hard},
    {"Alchemy",
     {.estimator = Estimator::alchemy2011, .bias = 0.005f, .epsilon = 0.01f, .intensity = 0.1f, .exponent = 2.0f},
     Falloff::hard},
    {"Nielsen's thesis",
     {.estimator = Estimator::nielsen2015, .bias = 0.001f, .epsilon = 0.1f, .intensity = 0.05f, .exponent = 1.5f},
     Falloff::hard},
    {"Nielsen's thesis, one layer, 30 pixels",
     {.estimator = Estimator::nielsen2015, .layers = 1, .epsilon = 0.1f, .intensity = 0.05f, .spread_pixels = 30},
     Falloff::hard},
    {"the thesis' taps", {.samples = 23, .pattern = TapPattern::nielsen2015}},
    {"the thesis' taps without MIP chain", {.pattern = TapPattern::nielsen2015, .use_mip_chain = false}},
    {"normals of faces", {.normals = ObscuranceNormals::face}},
    {"linear", {.estimator = Estimator::linear}},
    {"linear with a hard radius", {.estimator = Estimator::linear}, Falloff::hard},
    {"one tap", {.samples = 1}},
    {"odd number of taps", {.samples = 37, .bias = 0.1f, .epsilon = 0.01f, .intensity = 0.5f}},
};

TEST_P(AmbientObscuranceTest, AgreesWithItsCounterpartOnNoise) {
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(97, 66), 1);
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        const double ambiguous =
            expect_agreement(context(), noise, c.settings, ambient_visibility_within(0.8f, c.falloff));
        EXPECT_LT(ambiguous, 0.02);  // the test would otherwise look at too little
    }
}

TEST_P(AmbientObscuranceTest, AgreesWithItsCounterpartInARoom) {
    const counterpart::Layers layers = layers_of_patches(slanted_view(120, 80), obscuring_room());
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        EXPECT_LT(expect_agreement(context(), layers, c.settings, ambient_visibility_within(1.0f, c.falloff)), 0.02);
    }
}

TEST_P(AmbientObscuranceTest, AgreesWithItsCounterpartInTheCornellBoxThroughThePipeline) {
    const Scene scene = make_cornell();
    const View view(scene.cameras.front(), 96, 72);
    for (const int layers : {1, 2}) {
        const AmbientObscuranceSettings settings{.layers = layers};
        Quantities quantities = ambient_visibility_within(0.3f);
        quantities.planes.insert(quantities.planes.end(), planes_of_layers.begin(), planes_of_layers.end());
        Pipeline pipeline(context(), scene, unblurred(settings), quantities, view.width(), view.height());
        const Frame frame = pipeline.render(view).frame;
        EXPECT_LT(expect_agreement(layers_of_frame(view, frame), settings, quantities, frame.plane("ao")), 0.02);
    }
}

// Every case with cameras and image shapes of its own.
TEST_P(AmbientObscuranceTest, AgreesWithItsCounterpartOnNoiseInRandomViews) {
    unsigned seed = 100;
    for (const Case& c : cases) {
        const RandomView random = random_view(++seed, anywhere, 1200);
        SCOPED_TRACE(testing::Message() << c.name << ", " << random);
        EXPECT_LT(expect_agreement(context(), counterpart::random_layers(random.view, seed), c.settings,
                                   ambient_visibility_within(0.8f, c.falloff)),
                  0.05);
    }
}

TEST_P(AmbientObscuranceTest, AgreesWithItsCounterpartInRandomViewsThroughThePipeline) {
    unsigned seed = 200;
    std::size_t turn = 0;
    for (const Scene& scene : {make_cornell(), make_clutter()}) {
        for (const RandomView& random : random_views(seed, 4, bounds_over_time(scene), 1200)) {
            const Case& c = cases[(3 * turn++) % cases.size()];
            SCOPED_TRACE(testing::Message() << c.name << ", " << scene.name << ", " << random);
            Quantities quantities = ambient_visibility_within(0.3f, c.falloff);
            quantities.planes.insert(quantities.planes.end(), planes_of_layers.begin(), planes_of_layers.end());
            Method method = unblurred(c.settings);
            method.direct.emitters = method.direct.shadow.lamps = false;  // light is of no concern
            Pipeline pipeline(context(), scene, method, quantities, random.view.width(), random.view.height());
            const Frame frame = pipeline.render(random.view).frame;
            EXPECT_LT(expect_agreement(layers_of_frame(random.view, frame), c.settings, quantities, frame.plane("ao")),
                      0.05);
        }
        seed += 10;
    }
}

TEST_P(AmbientObscuranceTest, AnInfinitePlaneIsFullyVisible) {
    const std::vector<Patch> floor = {{{-500.0f, -1.0f, -900.0f}, {1000.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1000.0f}}};
    for (const AmbientObscuranceSettings& settings :
         {AmbientObscuranceSettings{.samples = 1000, .use_mip_chain = false},
          AmbientObscuranceSettings{.samples = 1000},
          AmbientObscuranceSettings{.samples = 1000, .normals = ObscuranceNormals::face},
          AmbientObscuranceSettings{.estimator = Estimator::nielsen2015, .samples = 1000}}) {
        ScreenSpaceRun run(context(), layers_of_patches(slanted_view(80, 60), floor), unblurred(settings),
                           ambient_visibility_within(2.0f));
        const Image ao = run.render("ao", 1);
        // Taps lie in the tangent plane up to rounding and to 0.003 degrees of the normal's encoding, 1e-4 m at 2 m:
        // all below the bias of 0.01 m. No other value than 1 is right, with the MIP chain as well: its points are
        // exact.
        for (const float value : ao.values()) {
            ASSERT_EQ(value, 1.0f) << to_string(settings.estimator) << ", MIP chain " << settings.use_mip_chain;
        }
    }
}

TEST_P(AmbientObscuranceTest, ACornerIsDarkerTheCloserOneComes) {
    const View view = slanted_view(81, 121);
    const counterpart::Layers layers = layers_of_patches(view, {obscuring_room()[0], obscuring_room()[1]});
    ScreenSpaceRun run(context(), layers, unblurred({.samples = 1000}), ambient_visibility_within(1.0f));
    const Image ao = run.render("ao", 1);
    // Down the middle column, wall pixels by their height above the floor.
    double last = 0.0;
    for (const float height : {0.1f, 0.3f, 0.6f, 1.2f}) {
        const double tan_half = view.tan_half().y;
        const int row = static_cast<int>(0.5 * (1.0 - (-1.0 + height) / 6.0 / tan_half) * view.height());
        const double visibility = ao.at(40, row);
        EXPECT_GT(visibility, last + 0.02) << height << " m above the floor";
        last = visibility;
    }
    EXPECT_EQ(last, 1.0) << "1.2 m above the floor nothing is within the radius of 1 m";
}

// The pattern of a seed, and that of a frame where taps vary in time.
TEST_P(AmbientObscuranceTest, SeedsMoveAndFramesTurnTheTapsAsTheFormulaSays) {
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(61, 42), 1);
    const Quantities quantities{.planes = {"ao.of_frame"}, .ao_radius = 0.8f};
    for (const auto& [vary, taps] : {std::pair{true, TapPattern::sao2012}, std::pair{false, TapPattern::sao2012},
                                     std::pair{true, TapPattern::nielsen2015}}) {
        AmbientObscuranceSettings settings{.samples = 7, .pattern = taps};
        settings.temporal = {.alpha = 0.9f, .vary_taps = vary};
        ScreenSpaceRun run(context(), noise, unblurred(settings), quantities);
        for (const auto& [seed, frame] : {std::pair{0u, 0}, std::pair{0u, 1}, std::pair{0u, 13}, std::pair{77u, 2}}) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", frame " << frame << ", varying " << vary);
            const counterpart::SpiralPattern pattern{pattern_shift(seed),
                                                     vary ? static_cast<std::uint32_t>(frame) : 0u};
            const Image ao = run.render("ao.of_frame", 1, 0, 0, seed, frame);
            EXPECT_LT(expect_agreement(run.layers(), settings, quantities, ao, pattern), 0.02);
        }
    }
}

TEST_P(AmbientObscuranceTest, ASecondLayerDarkensWhatHidesBehindTheFirst) {
    // A wall with a slab 0.2 m before it, and between camera and slab a board that hides the slab and no more.
    const std::vector<Patch> patches = {{{-5.0f, -5.0f, -5.0f}, {10.0f, 0.0f, 0.0f}, {0.0f, 10.0f, 0.0f}},
                                        {{-0.5f, -0.5f, -4.8f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}},
                                        {{-0.22f, -0.22f, -2.0f}, {0.44f, 0.0f, 0.0f}, {0.0f, 0.44f, 0.0f}}};
    const View view = slanted_view(100, 100);
    const counterpart::Layers layers = layers_of_patches(view, patches);
    const auto visibility = [&](int layer_count) {
        ScreenSpaceRun run(context(), layers, unblurred({.samples = 200, .layers = layer_count}),
                           ambient_visibility_within(1.0f));
        return run.render("ao", 1);
    };
    const Image one = visibility(1), two = visibility(2);
    int lower = 0;
    for (std::size_t i = 0; i < one.pixel_count(); ++i) {
        ASSERT_LE(two.values()[i], one.values()[i]) << "pixel " << i;
        lower += two.values()[i] < one.values()[i] - 0.02f;
    }
    // Around the board of about 19 pixels' side the wall is obscured by the slab behind, up to 0.5 m or 9 pixels away.
    EXPECT_GT(lower, 400);
    const int beside_board = 50 + 13;
    EXPECT_EQ(one.at(beside_board, 50), 1.0f) << "the board is 3 m away, the slab unseen";
    EXPECT_LT(two.at(beside_board, 50), 0.95f);
}

TEST_P(AmbientObscuranceTest, BackgroundAndRadiiBelowAPixelAreFullyVisible) {
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(40, 30), 5);
    {
        ScreenSpaceRun run(context(), noise, unblurred({}), ambient_visibility_within(0.01f));
        const Image ao = run.render("ao", 1);
        for (const float value : ao.values()) ASSERT_EQ(value, 1.0f);
    }
    ScreenSpaceRun run(context(), noise, unblurred({}), ambient_visibility_within(1.0f));
    const Image ao = run.render("ao", 1);
    for (std::size_t i = 0; i < ao.pixel_count(); ++i) {
        if (noise.depth[0].values()[i] == 0.0f) {
            ASSERT_EQ(ao.values()[i], 1.0f) << "background pixel " << i;
        }
    }
}

TEST_P(AmbientObscuranceTest, TheSameFrameGivesTheSameBitsAndAllocatesNothing) {
    Method method;  // blurred
    ScreenSpaceRun run(context(), counterpart::random_layers(slanted_view(128, 72), 2), method,
                       ambient_visibility_within(0.8f));
    const Image first = run.render("ao", 1);
    const std::size_t bytes = context().allocated_bytes();
    for (int frame = 0; frame < 3; ++frame) {
        const Image again = run.render("ao", 1);
        ASSERT_TRUE(std::ranges::equal(first.values(), again.values()));
    }
    EXPECT_EQ(context().allocated_bytes(), bytes);
}

TEST_P(AmbientObscuranceTest, TapsFallIntoTheGuardBandWhichIsDrawnOnlyWhereDirectLightReadsIt) {
    const int band = 20;
    const View view = slanted_view(60, 50).with_guard_band(band);
    const counterpart::Layers noise = counterpart::random_layers(view, 8);
    Method method = unblurred({});
    method.gbuffer.guard_band = band;
    for (const bool direct_light : {false, true}) {
        Quantities quantities = ambient_visibility_within(0.5f);
        if (direct_light) quantities.planes.push_back("direct");
        ScreenSpaceRun run(context(), noise, method, quantities);
        const Image ao = run.render("ao", 1);
        const int margin = direct_light ? 0 : band;
        for (int y = margin; y < view.height() - margin; ++y) {
            for (int x = margin; x < view.width() - margin; ++x) {
                const counterpart::Visibility expected =
                    counterpart::ambient_visibility(run.layers(), method.ao, quantities, {x, y});
                if (expected.ambiguous) continue;
                ASSERT_TRUE(is_right(ao.at(x, view.height() - 1 - y), expected)) << x << ", " << y;
            }
        }
    }
}

TEST_P(AmbientObscuranceTest, ParametersOutOfRangeAreRefusedWithTheRemedy) {
    const auto error_of = [&](const AmbientObscuranceSettings& settings, float radius,
                              Falloff falloff = Falloff::quadratic) -> std::string {
        try {
            ScreenSpaceRun run(context(), counterpart::random_layers(slanted_view(8, 8), 1), unblurred(settings),
                               ambient_visibility_within(radius, falloff));
        } catch (const MethodError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_THAT(error_of({}, std::numeric_limits<float>::infinity()), testing::HasSubstr("ao_radius is inf; set it"));
    EXPECT_THAT(error_of({.samples = 0}, 1.0f), testing::HasSubstr("use 1 to 1000"));
    EXPECT_THAT(error_of({.layers = 3}, 1.0f), testing::HasSubstr("use 1 or 2"));
    EXPECT_THAT(error_of({.epsilon = 0.0f}, 1.0f), testing::HasSubstr("must be positive"));
    EXPECT_THAT(error_of({.estimator = Estimator::sao2012_undivided}, 1.0f, Falloff::cubic),
                testing::HasSubstr("set ao.estimator to \"sao2012\""));
}

}  // namespace
}  // namespace plumb

#include "rasterizer/radiosity.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gl_test.h"
#include "radiosity_agreement.h"
#include "random_views.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/pipeline.h"
#include "rasterizer/scene_reach.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

using RadiosityTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(RadiosityTest);

const Quantities all_planes = {.planes = {"irradiance", "confidence", "indirect", "indirect.1"}};

// Returns the share of pixels that rounding leaves open.
double expect_agreement(GlContext& context, const counterpart::Layers& given, const RadiositySettings& settings) {
    ScreenSpaceRun run(context, given, unblurred(settings), all_planes);
    const Image irradiance = run.render("irradiance", 3), confidence = run.render("confidence", 1);
    return expect_agreement(run.layers(), settings, irradiance, confidence);
}

struct Case {
    const char* name;
    RadiositySettings settings;
};

const std::vector<Case> cases = {
    {"default", {}},
    {"one layer", {.layers = 1}},
    {"without MIP chain", {.use_mip_chain = false}},
    {"one layer without MIP chain", {.layers = 1, .use_mip_chain = false}},
    {"tap normals untested", {.test_tap_normal = false}},
    {"divided by the samples", {.normalisation = RadiosityNormalisation::samples}},
    {"coarse", {.mip_offset = 1, .minimum_mip_level = 2}},
    {"normals and radiance from chains", {.mip_offset = 1, .mip_normals_and_radiance = true}},
    {"points at the taps", {.mip_offset = 1, .mip_points = MipTapPoint::sao2012}},
    {"points at the taps, coarse", {.mip_offset = 1, .minimum_mip_level = 2, .mip_points = MipTapPoint::sao2012}},
    {"one tap", {.samples = 1}},
    {"small radius", {.samples = 99, .radius = 0.2f}},
};

TEST_P(RadiosityTest, AgreesWithItsCounterpartOnNoise) {
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(97, 66), 4);
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        EXPECT_LT(expect_agreement(context(), noise, c.settings), 0.05);
    }
}

// A texel of a chain is one of level 0: where it is read changes no bit of the light, through every bounce.
TEST_P(RadiosityTest, ChainsOfNormalsAndRadianceHoldWhatLevel0Does) {
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(97, 66), 4);
    for (const bool test_tap_normal : {true, false}) {
        RadiositySettings settings{.radius = 3.0f,
                                   .test_tap_normal = test_tap_normal,
                                   .mip_offset = 1,
                                   .bounces = 2,
                                   .second_layer = SecondLayerIndirect::gather};
        ScreenSpaceRun plain(context(), noise, unblurred(settings), all_planes);
        settings.mip_normals_and_radiance = true;
        ScreenSpaceRun chained(context(), noise, unblurred(settings), all_planes);
        for (const char* plane : {"irradiance", "confidence"}) {
            const Image a = plain.render(plane, 3), b = chained.render(plane, 3);
            EXPECT_TRUE(std::ranges::equal(a.values(), b.values())) << plane;
        }
        EXPECT_EQ(chained.planes().has("normal_mip_chain"), test_tap_normal);
        EXPECT_EQ(chained.planes().get("direct_mip_chain").layers(), 2);
        EXPECT_FALSE(plain.planes().has("direct_mip_chain"));
    }
}

TEST_P(RadiosityTest, LightCountsByTheFalloffOfItsDistance) {
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(97, 66), 4);
    for (const Falloff falloff : {Falloff::quadratic, Falloff::cubic}) {
        SCOPED_TRACE(to_string(falloff));
        Quantities quantities = all_planes;
        quantities.indirect_falloff = falloff;
        ScreenSpaceRun run(context(), noise, unblurred({}), quantities);
        const Image irradiance = run.render("irradiance", 3), confidence = run.render("confidence", 1);
        EXPECT_LT(expect_agreement(run.layers(), {}, irradiance, confidence, falloff), 0.05);
    }
}

// A bright red wall that meets a floor, and a table on it under which only the second layer sees.
counterpart::Layers room(const View& view) {
    return layers_of_patches(view, {{{-4.0f, -1.0f, -7.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 8.0f}},
                                    {{-4.0f, -1.0f, -6.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 6.0f, 0.0f}},
                                    {{-0.8f, -0.5f, -5.5f}, {1.6f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f}}});
}

TEST_P(RadiosityTest, AgreesWithItsCounterpartInARoom) {
    const counterpart::Layers layers = room(slanted_view(120, 80));
    for (const Case& c : cases) {
        if (!c.settings.test_tap_normal) continue;  // taps in the pixel's own plane: w.n is 0 but for rounding
        SCOPED_TRACE(c.name);
        EXPECT_LT(expect_agreement(context(), layers, c.settings), 0.05);
    }
}

TEST_P(RadiosityTest, AgreesWithItsCounterpartInTheCornellBoxThroughThePipeline) {
    const Scene scene = make_cornell();
    const View view(scene.cameras.front(), 96, 72);
    for (const int layers : {1, 2}) {
        const RadiositySettings settings{.layers = layers, .radius = 0.5f};
        Quantities quantities = all_planes;
        quantities.planes.insert(quantities.planes.end(), planes_of_layers.begin(), planes_of_layers.end());
        Pipeline pipeline(context(), scene, unblurred(settings), quantities, view.width(), view.height());
        const Frame frame = pipeline.render(view).frame;
        EXPECT_LT(expect_agreement(layers_of_frame(view, frame), settings, frame.plane("irradiance"),
                                   frame.plane("confidence")),
                  0.05);
    }
}

// Every case with cameras and image shapes of its own.
TEST_P(RadiosityTest, AgreesWithItsCounterpartOnNoiseInRandomViews) {
    unsigned seed = 300;
    for (const Case& c : cases) {
        const RandomView random = random_view(++seed, anywhere, 1200);
        SCOPED_TRACE(testing::Message() << c.name << ", " << random);
        EXPECT_LT(expect_agreement(context(), counterpart::random_layers(random.view, seed), c.settings), 0.1);
    }
}

TEST_P(RadiosityTest, AgreesWithItsCounterpartInRandomViewsThroughThePipeline) {
    unsigned seed = 400;
    std::size_t turn = 0;
    for (const Scene& scene : {make_cornell(), make_clutter()}) {
        for (const RandomView& random : random_views(seed, 4, bounds_over_time(scene), 1200)) {
            const Case& c = cases[(3 * turn++) % cases.size()];
            RadiositySettings settings = c.settings;
            settings.test_tap_normal = true;  // else taps in the pixel's own plane decide by rounding
            SCOPED_TRACE(testing::Message() << c.name << ", " << scene.name << ", " << random);
            Quantities quantities = all_planes;
            quantities.planes.insert(quantities.planes.end(), planes_of_layers.begin(), planes_of_layers.end());
            Method method = unblurred(settings);
            method.direct.shadow.cube_size = method.direct.shadow.emitter_size = 64;
            Pipeline pipeline(context(), scene, method, quantities, random.view.width(), random.view.height());
            const Frame frame = pipeline.render(random.view).frame;
            EXPECT_LT(expect_agreement(layers_of_frame(random.view, frame), settings, frame.plane("irradiance"),
                                       frame.plane("confidence")),
                      0.1);
        }
        seed += 10;
    }
}

TEST_P(RadiosityTest, ReflectedLightIsAlbedoOverPiOfTheIrradiance) {
    ScreenSpaceRun run(context(), room(slanted_view(60, 40)), Method{}, all_planes);
    const Image irradiance = run.render("irradiance", 3), indirect = run.render("indirect", 3),
                first_bounce = run.render("indirect.1", 3);
    for (std::size_t i = 0; i < irradiance.values().size(); ++i) {
        const float expected = 0.5f / 3.14159265f * irradiance.values()[i];      // the room's albedo is 0.5
        ASSERT_NEAR(indirect.values()[i], expected, 1e-6f * (1.0f + expected));  // two float roundings
        ASSERT_EQ(first_bounce.values()[i], indirect.values()[i]);
    }
}

TEST_P(RadiosityTest, IrradianceIsProportionalToTheLight) {
    counterpart::Layers layers = room(slanted_view(60, 40));
    const auto irradiance = [&] {
        ScreenSpaceRun run(context(), layers, Method{}, all_planes);
        return run.render("irradiance", 3);
    };
    const Image single = irradiance();
    for (Image& radiance : layers.radiance) {
        for (float& value : radiance.values()) value *= 2.0f;
    }
    const Image twofold = irradiance();
    float largest = 0.0f;
    for (std::size_t i = 0; i < single.values().size(); ++i) {
        ASSERT_EQ(twofold.values()[i], 2.0f * single.values()[i]);  // a power of two: bit for bit
        largest = std::max(largest, single.values()[i]);
    }
    EXPECT_GT(largest, 1.0f) << "wall and floor light each other";
    for (Image& radiance : layers.radiance) radiance = Image(60, 40, 3);
    const Image dark = irradiance();
    for (const float value : dark.values()) ASSERT_EQ(value, 0.0f);
}

TEST_P(RadiosityTest, AnInfinitePlaneReceivesNothingFromItself) {
    const std::vector<Patch> floor = {{{-500.0f, -1.0f, -900.0f}, {1000.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1000.0f}}};
    ScreenSpaceRun run(context(), layers_of_patches(slanted_view(60, 40), floor), unblurred({.samples = 200}),
                       all_planes);
    const Image irradiance = run.render("irradiance", 3), confidence = run.render("confidence", 1);
    for (const float value : irradiance.values()) ASSERT_EQ(value, 0.0f);
    for (const float value : confidence.values()) ASSERT_EQ(value, 0.0f);
}

TEST_P(RadiosityTest, ASecondLayerBringsLightFromBehindTheFirst) {
    // A floor below a wall whose lower part, all that lights the floor's far end, hides behind a board.
    const std::vector<Patch> patches = {{{-4.0f, -1.0f, -6.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 3.0f}},
                                        {{-4.0f, -1.0f, -6.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 0.4f, 0.0f}},
                                        {{-3.0f, -0.33f, -2.0f}, {6.0f, 0.0f, 0.0f}, {0.0f, 0.14f, 0.0f}}};
    const counterpart::Layers layers = layers_of_patches(slanted_view(100, 100), patches);
    const auto irradiance = [&](int layer_count) {
        ScreenSpaceRun run(context(), layers, unblurred({.samples = 200, .layers = layer_count}), all_planes);
        return run.render("irradiance", 3);
    };
    const Image one = irradiance(1), two = irradiance(2);
    int brighter = 0;
    for (int i = 0; i < 100 * 100; ++i) {
        brighter += two.values()[std::size_t(i) * 3] > one.values()[std::size_t(i) * 3] + 0.1f;
    }
    EXPECT_GT(brighter, 100) << "of 10000 pixels";
}

TEST_P(RadiosityTest, TheSameFrameGivesTheSameBitsAndAllocatesNothing) {
    ScreenSpaceRun run(context(), counterpart::random_layers(slanted_view(128, 72), 2), Method{}, all_planes);
    const Image first = run.render("indirect", 3);
    const std::size_t bytes = context().allocated_bytes();
    for (int frame = 0; frame < 3; ++frame) {
        const Image again = run.render("indirect", 3);
        ASSERT_TRUE(std::ranges::equal(first.values(), again.values()));
    }
    EXPECT_EQ(context().allocated_bytes(), bytes);
}

TEST_P(RadiosityTest, OnlyOutputsThatAreReadAreAllocated) {
    ScreenSpaceRun run(context(), counterpart::random_layers(slanted_view(16, 16), 2), Method{},
                       {.planes = {"indirect"}});
    EXPECT_TRUE(run.planes().has("indirect"));
    for (const char* plane : {"irradiance", "confidence", "indirect.1", "ao"}) EXPECT_FALSE(run.planes().has(plane));
}

TEST_P(RadiosityTest, ParametersOutOfRangeAreRefusedWithTheRemedy) {
    const auto error_of = [&](const RadiositySettings& settings) -> std::string {
        try {
            ScreenSpaceRun run(context(), counterpart::random_layers(slanted_view(8, 8), 1), unblurred(settings),
                               all_planes);
        } catch (const MethodError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_THAT(error_of({.radius = std::numeric_limits<float>::infinity()}),
                testing::HasSubstr("use a finite length"));
    EXPECT_THAT(error_of({.samples = 2000}), testing::HasSubstr("use 1 to 1000"));
    EXPECT_THAT(error_of({.use_mip_chain = false, .minimum_mip_level = 2}),
                testing::HasSubstr("use_mip_chain is false"));
}

}  // namespace
}  // namespace plumb

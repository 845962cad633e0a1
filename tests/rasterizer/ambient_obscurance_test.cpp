#include "rasterizer/ambient_obscurance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ambient_obscurance_counterpart.h"
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
using AmbientObscuranceTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(AmbientObscuranceTest);

Method unblurred(AmbientObscuranceSettings ao) {
    ao.blur.radius = 0;
    Method method;
    method.ao = ao;
    return method;
}

Quantities ambient_visibility_within(float radius, Falloff falloff = Falloff::quadratic) {
    return {.planes = {"ao"}, .ao_radius = radius, .ao_falloff = falloff};
}

// Compares image and counterpart pixel by pixel; returns the share of pixels that rounding leaves open.
double expect_agreement(const counterpart::Layers& layers, const AmbientObscuranceSettings& settings,
                        const Quantities& quantities, const Image& ao, const counterpart::SpiralPattern& pattern = {}) {
    const int width = layers.width(), height = layers.height();
    int ambiguous = 0, wrong = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const counterpart::Visibility expected =
                counterpart::ambient_visibility(layers, settings, quantities, {x, y}, pattern);
            ambiguous += expected.ambiguous;
            if (expected.ambiguous) continue;
            const double actual = ao.at(x, height - 1 - y);
            // Float positions 4 m away are good to 1e-6 m; divided by sqrt(eps) = 0.03 m (sao2012: by eps = 0.001 m^2,
            // but times heights below 1 m) a tap's obscurance is good to about 3e-5 (1e-3). The square root of the mean
            // is steep near 0, so its square is compared there.
            const double tolerance = settings.estimator == Estimator::sao2012 ? 1e-3 : 1e-4;
            const double square_error =
                std::abs(std::pow(1.0 - actual, 2.0) - std::pow(1.0 - expected.visibility, 2.0));
            const bool right = std::abs(actual - expected.visibility) < tolerance || square_error < tolerance;
            if (!right && ++wrong < 5) {
                ADD_FAILURE() << "pixel (" << x << ", " << y << ") from the bottom left: " << actual << ", expected "
                              << expected.visibility << " (mean obscurance " << expected.mean << ")";
            }
        }
    }
    EXPECT_EQ(wrong, 0);
    return static_cast<double>(ambiguous) / (width * height);
}

double expect_agreement(GlContext& context, const counterpart::Layers& given, const AmbientObscuranceSettings& settings,
                        const Quantities& quantities) {
    ScreenSpaceRun run(context, given, unblurred(settings), quantities);
    const Image ao = run.render("ao", 1);
    return expect_agreement(run.layers(), settings, quantities, ao);
}

struct Case {
    const char* name;
    AmbientObscuranceSettings settings;
    Falloff falloff = Falloff::quadratic;
};

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

// A floor, a wall, and a table in front of them under which the second layer sees.
std::vector<Patch> room() {
    return {{{-4.0f, -1.0f, -7.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 8.0f}},
            {{-4.0f, -1.0f, -6.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 6.0f, 0.0f}},
            {{-0.8f, -0.5f, -5.5f}, {1.6f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f}}};
}

TEST_P(AmbientObscuranceTest, AgreesWithItsCounterpartInARoom) {
    const counterpart::Layers layers = layers_of_patches(slanted_view(120, 80), room());
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

// A view as narrow as a pixel of 700 lines: coarser ones lose every normal to the source's limit.
View narrow_view(int width, int height) {
    return View(Camera::look_at("narrow", {1.0f, 2.0f, 3.0f}, {-2.0f, 0.5f, 1.0f}, 0.3f), width, height);
}

TEST_P(AmbientObscuranceTest, NormalsByDerivativesAgreeWithTheirCounterpartAndAreRejectedAtEdges) {
    for (const View& view : {narrow_view(120, 80), narrow_view(119, 79)}) {
        // A board before a floor and a wall, which meets it: edges in depth, and slants on either side of the limit.
        const counterpart::Layers layers =
            layers_of_patches(view, {{{-4.0f, -0.5f, -7.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 8.0f}},
                                     {{-4.0f, -1.0f, -6.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 6.0f, 0.0f}},
                                     {{-0.2f, -0.3f, -4.5f}, {0.5f, 0.0f, 0.2f}, {0.0f, 0.5f, 0.1f}}});
        for (const Case& c :
             std::vector<Case>{{"the demo's", {.estimator = Estimator::g3d_demo}}, {"as the paper", {.samples = 40}}}) {
            SCOPED_TRACE(c.name);
            AmbientObscuranceSettings settings = c.settings;
            settings.normals = ObscuranceNormals::g3d_demo;
            EXPECT_LT(expect_agreement(context(), layers, settings, ambient_visibility_within(0.5f)), 0.02);
        }
        int rejected = 0, kept = 0;
        for (int y = 0; y < view.height() / 2 * 2; ++y) {
            for (int x = 0; x < view.width() / 2 * 2; ++x) {
                const bool found = counterpart::derivative_normal(layers, {x, y}).normal != glm::dvec3(0.0);
                kept += found, rejected += !found;
            }
        }
        EXPECT_GT(kept, 120 * 80 / 2);
        EXPECT_GT(rejected, 100) << "edges, and the floor where it is seen at a flat angle";
    }
}

TEST_P(AmbientObscuranceTest, AtFewLinesTheSourcesLimitRejectsEveryNormal) {
    const counterpart::Layers layers = layers_of_patches(slanted_view(60, 45), room());
    ScreenSpaceRun run(context(), layers, unblurred({.normals = ObscuranceNormals::g3d_demo}),
                       ambient_visibility_within(1.0f));
    const Image ao = run.render("ao", 1);
    for (const float value : ao.values()) ASSERT_EQ(value, 1.0f);
}

// What the source's points cost: the depth of another pixel lifts taps off a slanted surface.
TEST_P(AmbientObscuranceTest, PointsAtTheTapsDarkenASlantedPlane) {
    const std::vector<Patch> floor = {{{-500.0f, -1.0f, -900.0f}, {1000.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1000.0f}}};
    ScreenSpaceRun run(context(), layers_of_patches(slanted_view(80, 60), floor),
                       unblurred({.samples = 1000, .mip_points = MipTapPoint::sao2012}),
                       ambient_visibility_within(2.0f));
    const Image ao = run.render("ao", 1);
    const auto dark = std::ranges::count_if(ao.values(), [](float value) { return value < 0.99f; });
    EXPECT_GT(dark, 80 * 60 / 4) << "of 80 * 60 pixels, none of which is obscured";
}

TEST_P(AmbientObscuranceTest, PointsAtTheTapsCannotBeStoredOnes) {
    const Scene scene = make_cornell();
    const auto message = [&](const Method& method, const std::string& plane) -> std::string {
        try {
            Pipeline(context(), scene, method, {.planes = {plane}, .ao_radius = 0.3f}, 32, 32);
        } catch (const MethodError& error) {
            return error.what();
        }
        return "no error";
    };
    Method method;
    method.gbuffer.position = PositionSource::stored;
    method.ao.mip_points = method.radiosity.mip_points = MipTapPoint::sao2012;
    EXPECT_THAT(message(method, "ao"), testing::HasSubstr("\"from_depth\" or ao.mip_points to \"exact\""));
    EXPECT_THAT(message(method, "irradiance"), testing::HasSubstr("or radiosity.mip_points to \"exact\""));
    method.ao.use_mip_chain = method.radiosity.use_mip_chain = false;
    EXPECT_EQ(message(method, "ao"), "no error");
    EXPECT_EQ(message(method, "irradiance"), "no error");
}

TEST_P(AmbientObscuranceTest, ACornerIsDarkerTheCloserOneComes) {
    const View view = slanted_view(81, 121);
    const counterpart::Layers layers = layers_of_patches(view, {room()[0], room()[1]});
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

// Floor, ceiling, walls and end of a corridor, with a shelf across it: something near every point.
std::vector<Patch> corridor() {
    return {{{-1.0f, -1.0f, -7.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
            {{-1.0f, 1.0f, -7.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
            {{-1.0f, -1.0f, -7.0f}, {0.0f, 2.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
            {{1.0f, -1.0f, -7.0f}, {0.0f, 2.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
            {{-1.0f, -1.0f, -5.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 2.0f, 0.0f}},
            {{-1.0f, -0.4f, -4.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.1f, 0.8f}}};
}

// Mean error of 1000 taps, and of four seeds of as many, against the limit of many taps.
void expect_convergence(GlContext& context, const Case& c) {
    SCOPED_TRACE(c.name);
    const counterpart::Layers layers = layers_of_patches(slanted_view(60, 45), corridor());
    AmbientObscuranceSettings settings = c.settings;
    const Quantities quantities = ambient_visibility_within(2.0f, c.falloff);
    std::vector<std::pair<counterpart::Pixel, double>> limits;
    double obscured = 0.0;
    for (int y = 4; y < 45; y += 9) {
        for (int x = 4; x < 60; x += 11) {
            const double expected = counterpart::limit_of_many_taps(layers, settings, quantities, {x, y}).visibility;
            limits.push_back({{x, y}, expected});
            obscured += 1.0 - expected;
        }
    }
    EXPECT_GT(obscured, 0.05 * static_cast<double>(limits.size()));
    // Of visibilities, whose curve bends little over the noise of a thousand taps.
    const auto mean_error = [&](int samples, int seeds = 1) {
        settings.samples = samples;
        ScreenSpaceRun run(context, layers, unblurred(settings), quantities);
        const Image ao = mean_over_seeds(run, "ao", 1, seeds);
        double error = 0.0;
        for (const auto& [pixel, expected] : limits) error += std::abs(ao.at(pixel.x, 44 - pixel.y) - expected);
        return error / obscured;
    };
    const double few = mean_error(16), many = mean_error(1000), thousands = mean_error(1000, 4);
    // As the taps of radiosity: N points miss edges by some N^(-3/4).
    EXPECT_LT(many, 0.03) << "relative error of 1000 taps; of 16: " << few;
    EXPECT_LT(many, few / 4.0) << few;
    EXPECT_LT(thousands, 0.01) << "relative error of 4 seeds of 1000 taps; of one: " << many;
    EXPECT_LT(thousands, many);
}

TEST_P(AmbientObscuranceTest, ConvergesToItsIntegralOverTheDisc) {
    expect_convergence(context(), {"the paper's", {.use_mip_chain = false}});
    expect_convergence(context(), {"the paper's, with the MIP chain", {}});
}

// Through EGL alone: they are the same taps.
TEST(AmbientObscurance, EveryEstimatorConvergesToItsIntegralOverTheDisc) {
    for (Case c :
         std::vector<Case>{{"linear", {.estimator = Estimator::linear}},
                           {"one layer", {.layers = 1}},
                           {"the demo's", {.estimator = Estimator::g3d_demo}},
                           {"SAO", {.estimator = Estimator::sao2012, .intensity = 0.3f}, Falloff::cubic},
                           {"SAO undivided", {.estimator = Estimator::sao2012_undivided, .intensity = 0.1f}},
                           {"Alchemy",
                            {.estimator = Estimator::alchemy2011,
                            .bias = 0.005f,
                            .epsilon = 0.1f,
                            .intensity = 0.3f,
                            .exponent = 2.0f},
                            Falloff::hard},
                           {"Nielsen's thesis",
                            {.estimator = Estimator::nielsen2015, .bias = 0.001f, .epsilon = 0.3f, .intensity = 0.1f},
                            Falloff::hard}}) {
        c.settings.use_mip_chain = false;
        expect_convergence(test_context(GlBackend::egl), c);
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
                // As in expect_agreement; on noise no pixel is so near 1 that the square root is steep.
                ASSERT_NEAR(ao.at(x, view.height() - 1 - y), expected.visibility, 1e-3) << x << ", " << y;
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

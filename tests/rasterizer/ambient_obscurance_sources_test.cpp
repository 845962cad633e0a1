// What the sources of ambient obscurance do otherwise than what is done here by default: against the CPU, and what it
// costs.
#include <algorithm>

#include <gmock/gmock.h>

#include "ambient_obscurance_agreement.h"
#include "gl_test.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/pipeline.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

using Estimator = AmbientObscuranceEstimator;
using Case = ObscuranceCase;
using ObscuranceSourcesTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(ObscuranceSourcesTest);

// A view as narrow as a pixel of 700 lines: coarser ones lose every normal to the source's limit.
View narrow_view(int width, int height) {
    return View(Camera::look_at("narrow", {1.0f, 2.0f, 3.0f}, {-2.0f, 0.5f, 1.0f}, 0.3f), width, height);
}

TEST_P(ObscuranceSourcesTest, NormalsByDerivativesAgreeWithTheirCounterpartAndAreRejectedAtEdges) {
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

// At so few lines that nothing has a normal, the pass says so, and how many lines would do.
TEST_P(ObscuranceSourcesTest, AtFewLinesTheSourcesLimitWouldRejectEveryNormal) {
    const std::vector<Patch> wall = {{{-40.0f, -30.0f, -6.0f}, {80.0f, 0.0f, 0.0f}, {0.0f, 60.0f, 0.0f}}};
    const auto image = [&](int lines) {
        // Square, and looking at the wall: a pixel's side is 2 tan(0.45) / lines of the distance.
        const View view(Camera::look_at("front", {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, 0.9f), lines, lines);
        const counterpart::Layers layers = layers_of_patches(view, wall);
        ScreenSpaceRun run(context(), layers, unblurred({.samples = 1, .normals = ObscuranceNormals::g3d_demo}),
                           ambient_visibility_within(1.0f));
        int kept = 0;
        for (int y = 0; y < lines; ++y) {
            for (int x = 0; x < lines; ++x)
                kept += counterpart::derivative_normal(layers, {x, y}).normal != glm::dvec3(0.0);
        }
        run.render("ao", 1);
        return kept;
    };
    // 2 tan(0.45) / sqrt(6e-5) = 124.7
    EXPECT_GT(image(126), 126 * 126 / 2);
    try {
        image(124);
        ADD_FAILURE() << "no error";
    } catch (const MethodError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("render 125 lines or more"));
    }
}

TEST_P(ObscuranceSourcesTest, AProbesFewLinesTakeTheSurfacesNormals) {
    Scene scene = make_cornell();
    scene.environment.radiance = glm::vec3(1.0f);  // which ambient visibility dims
    const View view(scene.cameras.front(), 160, 160);
    const auto irradiance = [&](ObscuranceNormals normals) {
        Method method;
        method.ao.normals = normals;
        method.probe = {.y = 0.3f, .size = 32};
        method.radiosity.fill = AmbientSource::probe;
        method.direct.emitters = false;
        Pipeline pipeline(context(), scene, method, {.planes = {"irradiance"}, .ao_radius = 0.3f}, 160, 160);
        return pipeline.render(view).frame.plane("irradiance");
    };
    const Image with_g3d = irradiance(ObscuranceNormals::g3d_demo);
    EXPECT_GT(*std::ranges::max_element(with_g3d.values()), 0.0f);
}

// What the source's points cost: the depth of another pixel lifts taps off a slanted surface.
TEST_P(ObscuranceSourcesTest, PointsAtTheTapsDarkenASlantedPlane) {
    const std::vector<Patch> floor = {{{-500.0f, -1.0f, -900.0f}, {1000.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1000.0f}}};
    ScreenSpaceRun run(context(), layers_of_patches(slanted_view(80, 60), floor),
                       unblurred({.samples = 1000, .mip_points = MipTapPoint::sao2012}),
                       ambient_visibility_within(2.0f));
    const Image ao = run.render("ao", 1);
    const auto dark = std::ranges::count_if(ao.values(), [](float value) { return value < 0.99f; });
    EXPECT_GT(dark, 80 * 60 / 4) << "of 80 * 60 pixels, none of which is obscured";
}

TEST_P(ObscuranceSourcesTest, PointsAtTheTapsCannotBeStoredOnes) {
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

}  // namespace
}  // namespace plumb

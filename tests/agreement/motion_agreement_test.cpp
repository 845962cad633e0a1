// Motion vectors of both renderers where the camera and the things before it move at once.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "pathtracer/reference.h"
#include "rasterizer/gl_context.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/instance_motion.h"
#include "rasterizer/pipeline.h"
#include "scenes/scene_file.h"

namespace plumb::test {
namespace {

class MotionAgreement : public testing::TestWithParam<GlBackend> {};

TEST_P(MotionAgreement, OfMovingThingsSeenByAMovingCamera) {
    const Scene scene = load_scene("clutter-moving", {});
    const auto context = GlContext::create(GetParam());
    Method method;
    method.gbuffer.minimum_separation = 0.05f;
    Quantities quantities;
    quantities.planes = {"motion",       "layer2.motion",   "depth",
                         "layer2.depth", "moving_instance", "layer2.moving_instance"};
    const CameraPath& path = scene.path("strafe");
    const std::vector<int> numbers = moving_instance_numbers(scene);
    const int width = 240, height = 160;
    Pipeline pipeline(*context, scene, method, quantities, width, height);
    for (const double time : {0.4, 1.6}) {
        const double before = time - 0.1;
        const View view(path.at(static_cast<float>(time)), width, height);
        const View previous(path.at(static_cast<float>(before)), width, height);
        const Frame exact =
            PathTracer(scene, {before, time}).gbuffer(view, {.minimum_separation = 0.05f, .previous_view = &previous});
        const Frame frame = pipeline.render({.now = {view, time}, .previous = Moment{previous, before}}).frame;
        for (const std::string prefix : {"", "layer2."}) {
            int compared = 0, wrong = 0, moving = 0, of_another = 0;
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    const float depth = exact.plane(prefix + "depth").at(x, y);
                    if (!std::isfinite(depth)) continue;
                    // At silhouettes the two may see other surfaces.
                    if (!(std::abs(frame.plane(prefix + "depth").at(x, y) - depth) < 1e-4f * depth)) continue;
                    ++compared;
                    const int instance = static_cast<int>(exact.plane(prefix + "instance").at(x, y));
                    moving += scene.instances[instance].moves();
                    of_another += static_cast<int>(frame.plane(prefix + "moving_instance").at(x, y)) !=
                                  numbers.at(static_cast<std::size_t>(instance));
                    for (int c = 0; c < 2; ++c) {
                        const float a = frame.plane(prefix + "motion").at(x, y, c);
                        const float b = exact.plane(prefix + "motion").at(x, y, c);
                        // Depths that differ by 1e-4 shift a point by as much of its displacement, which is up to 30
                        // pixels; float positions resolve some 1e-4 of a pixel besides.
                        if (!(std::abs(a - b) < 5e-3f)) ++wrong;
                    }
                }
            }
            EXPECT_GT(compared, width * height / 8) << prefix;
            EXPECT_GT(moving, 200) << prefix << ": too few pixels of moving things to tell";
            // Edge-on surfaces: the same depth, another point.
            EXPECT_LE(wrong, compared / 1000) << prefix << " at " << time << " s: " << wrong << " of " << compared;
            EXPECT_LE(of_another, compared / 1000)
                << prefix << " at " << time << " s: " << of_another << " of " << compared;
        }
    }
}

// Fed with the exact depth and instance of every pixel, it finds the exact motion of every pixel.
TEST_P(MotionAgreement, OfTheTruthsOwnLayers) {
    const Scene scene = load_scene("clutter-moving", {});
    const auto context = GlContext::create(GetParam());
    Method method;
    method.gbuffer.source = SourceOfStage::truth;
    method.gbuffer.minimum_separation = 0.05f;
    Quantities quantities;
    quantities.planes = {"motion", "layer2.motion"};
    const CameraPath& path = scene.path("strafe");
    const int width = 240, height = 160;
    Pipeline pipeline(*context, scene, method, quantities, width, height);
    const double time = 0.4, before = 0.3;
    const View view(path.at(static_cast<float>(time)), width, height);
    const View previous(path.at(static_cast<float>(before)), width, height);
    Frame exact =
        PathTracer(scene, {before, time}).gbuffer(view, {.minimum_separation = 0.05f, .previous_view = &previous});
    const FrameRequest request{.now = {view, time}, .previous = Moment{previous, before}, .truth = &exact};
    const Frame frame = pipeline.render(request).frame;
    for (const std::string prefix : {"", "layer2."}) {
        int compared = 0, moving = 0;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                if (!std::isfinite(exact.plane(prefix + "depth").at(x, y))) continue;
                ++compared;
                moving += scene.instances[static_cast<int>(exact.plane(prefix + "instance").at(x, y))].moves();
                for (int c = 0; c < 2; ++c) {
                    const float a = frame.plane(prefix + "motion").at(x, y, c);
                    const float b = exact.plane(prefix + "motion").at(x, y, c);
                    // Float positions resolve some 1e-4 of a pixel, and hits by rays those of triangles to 1e-5 m at
                    // slants; motion is up to 30 pixels.
                    ASSERT_NEAR(a, b, 2e-3f) << prefix << "pixel (" << x << ", " << y << ")";
                }
            }
        }
        EXPECT_GT(compared, width * height / 8) << prefix;
        EXPECT_GT(moving, 200) << prefix << ": too few pixels of moving things to tell";
    }
    exact.set("instance", Image(width, height, 1, 1000.0f));
    try {
        pipeline.render(request);
        FAIL() << "an instance that the scene does not have";
    } catch (const MethodError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("'instance' holds 1000"));
    }
}

INSTANTIATE_TEST_SUITE_P(Backend, MotionAgreement, testing::Values(GlBackend::egl, GlBackend::osmesa),
                         [](const auto& parameter) { return std::string(to_string(parameter.param)); });

}  // namespace
}  // namespace plumb::test

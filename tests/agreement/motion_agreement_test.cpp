// Motion vectors of both renderers where the camera and the things before it move at once.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pathtracer/reference.h"
#include "rasterizer/gl_context.h"
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
    quantities.planes = {"motion", "layer2.motion", "depth", "layer2.depth"};
    const CameraPath& path = scene.path("strafe");
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
            int compared = 0, wrong = 0, moving = 0;
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    const float depth = exact.plane(prefix + "depth").at(x, y);
                    if (!std::isfinite(depth)) continue;
                    // At silhouettes the two may see other surfaces.
                    if (!(std::abs(frame.plane(prefix + "depth").at(x, y) - depth) < 1e-4f * depth)) continue;
                    ++compared;
                    const int instance = static_cast<int>(exact.plane(prefix + "instance").at(x, y));
                    moving += scene.instances[instance].moves();
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
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Backend, MotionAgreement, testing::Values(GlBackend::egl, GlBackend::osmesa),
                         [](const auto& parameter) { return std::string(to_string(parameter.param)); });

}  // namespace
}  // namespace plumb::test

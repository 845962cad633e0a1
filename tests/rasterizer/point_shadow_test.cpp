// The shadow maps of point lights per pixel: each lookup against maps that rays have made.
#include <functional>

#include <fmt/format.h>

#include "gl_test.h"
#include "point_shadow_counterpart.h"
#include "shadow_rays.h"

namespace plumb {
namespace {

using PointShadowTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(PointShadowTest);

constexpr int texels = 128;

Scene make_lamp_scene() {
    Scene scene = make_shadow_scene();
    scene.point_lights.push_back({"lamp", {0.4f, 1.9f, 0.9f}, {9.0f, 7.0f, 5.0f}});
    return scene;
}

struct Comparison {
    int compared = 0, partly = 0, different = 0;
};

// Visibility as the rasterizer's light tells it, and as `expected` has it.
Comparison compare(GlContext& context, const Scene& scene, const Method& method,
                   const std::function<counterpart::Visibility(const counterpart::Receiver&)>& expected) {
    const View view = near_view();
    const PointLight& lamp = scene.point_lights[0];
    const Frame frame = render(context, scene, view, {"position", "normal", "albedo", "direct", "depth"}, method);
    Comparison result;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            if (std::isinf(frame.plane("depth").at(x, y))) continue;
            const counterpart::Receiver receiver{vector_at(frame.plane("position"), x, y) - glm::dvec3(lamp.position),
                                                 vector_at(frame.plane("normal"), x, y)};
            const double distance = glm::length(receiver.from_lamp);
            const double cosine = -glm::dot(receiver.normal, receiver.from_lamp) / distance;
            if (cosine < 0.05) continue;  // little light to tell visibility by
            const counterpart::Visibility visibility = expected(receiver);
            if (!visibility) continue;
            const double unshadowed =
                frame.plane("albedo").at(x, y) / glm::pi<double>() * lamp.intensity.x * cosine / (distance * distance);
            ++result.compared;
            result.partly += *visibility > 0.05 && *visibility < 0.95;
            // Half floats, and filter weights of 8 bits.
            result.different += std::abs(frame.plane("direct").at(x, y) / unshadowed - *visibility) > 0.012;
        }
    }
    EXPECT_GT(result.compared, 3000);
    EXPECT_GT(result.partly, 50);
    EXPECT_LT(result.partly, result.compared / 10) << "at shadows' edges only: nothing shades itself";
    return result;
}

TEST_P(PointShadowTest, CubesAreLookedUpTexelByTexel) {
    const Scene scene = make_lamp_scene();
    const RayCaster caster(scene);
    for (const CubeDistance distance : {CubeDistance::reciprocal, CubeDistance::linear}) {
        const counterpart::TracedCube cube(caster, glm::dvec3(scene.point_lights[0].position), texels,
                                           distance == CubeDistance::linear);
        for (const CubeGeneration generation : {CubeGeneration::six_views, CubeGeneration::one_pass}) {
            Method method = plain_method();
            method.direct.shadow.cube_size = texels;
            method.direct.shadow.cube_distance = distance;
            method.direct.shadow.cube_generation = generation;
            const Comparison result = compare(context(), scene, method, [&](const counterpart::Receiver& receiver) {
                return cube.lit(receiver, method.direct.shadow.bias);
            });
            fmt::print("cube: {} of {} differ, {} partly lit\n", result.different, result.compared, result.partly);
            // Texels at silhouettes, whose centre the rasterizer's grid of 1/256 texel sees on the other side.
            EXPECT_LE(result.different, result.compared / 100);
        }
    }
}

TEST_P(PointShadowTest, ParaboloidsAreLookedUpTexelByTexel) {
    const Scene scene = make_lamp_scene();
    const RayCaster caster(scene);
    const counterpart::TracedParaboloids paraboloids(caster, glm::dvec3(scene.point_lights[0].position), texels);
    Method method = plain_method();
    method.direct.shadow.point_map = PointShadowMap::dual_paraboloid;
    method.direct.shadow.paraboloid_size = texels;
    method.direct.shadow.paraboloid_tessellation = 64;
    const Comparison result = compare(context(), scene, method, [&](const counterpart::Receiver& receiver) {
        return paraboloids.lit(receiver, method.direct.shadow.bias);
    });
    fmt::print("paraboloids: {} of {} differ, {} partly lit\n", result.different, result.compared, result.partly);
    EXPECT_LE(result.different, result.compared / 100);
}

}  // namespace
}  // namespace plumb

// Coarse meshes with normals of the smooth surface that they stand for: light that the faces would keep from each
// other though the surface does not, and none where other surfaces keep it away.
#include <cmath>

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "pathtracer/environment_distribution.h"
#include "pathtracer/light_table.h"
#include "pathtracer/path_integrator.h"
#include "pathtracer/traced_scene.h"
#include "tests/pathtracer/test_scenes.h"

namespace plumb {
namespace {

constexpr float albedo = 0.6f;

// The share of the ball's pixels whose `direct` is not what the smooth ball has under light from `towards`, of that
// irradiance; the ball is all there is.
double share_that_differs(const Scene& scene, const View& view, const glm::vec3& towards, float irradiance) {
    const Frame frame = PathTracer(scene).render(view, settings_for({"direct", "normal"}, 2)).frame;
    int seen = 0, different = 0;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            const glm::vec3 normal = colour_at(frame.plane("normal"), x, y);
            if (normal == glm::vec3(0.0f)) continue;
            ++seen;
            const float expected =
                albedo * glm::one_over_pi<float>() * irradiance * std::max(0.0f, glm::dot(normal, towards));
            // Of half the brightest value a millionth, for float32.
            different += std::abs(frame.plane("direct").at(x, y) - expected) > 1e-6f * irradiance ? 1 : 0;
        }
    }
    EXPECT_GT(seen, view.width() * view.height() / 8);
    return static_cast<double>(different) / seen;
}

// Seen from the side, so that the ball's terminator runs through the picture. Were light kept away by the faces that it
// comes from behind, 13 %, 3 % and 2 % of the pixels of 32, 128 and 512 faces would be black where the ball is lit.
// What is left is at the very corners of faces, where there is next to no bulge; no pixel's centre need lie there.
TEST(SmoothSurface, HasNoBlackFacesAtItsTerminator) {
    const glm::vec3 towards = glm::normalize(glm::vec3(1.0f, 0.3f, 0.2f));
    for (const int subdivisions : {1, 2, 3}) {
        Scene scene;
        add_smooth_ball(scene, add_material(scene, glm::vec3(albedo), glm::vec3(0.0f), false), subdivisions);
        scene.directional_lights.push_back({"sun", -towards, glm::vec3(2.0f)});
        const double share = share_that_differs(scene, view_of({0, 0, 4}, {0, 0, 0}, 0.55f, 128), towards, 2.0f);
        EXPECT_LT(share, 0.001) << subdivisions << " subdivisions";
    }
}

glm::vec3 face_normal(const Mesh& mesh, std::size_t triangle) {
    const auto corner = [&](int k) { return mesh.positions[mesh.triangles[triangle][k]]; };
    return glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
}

// What points all over one face get from the scene's lights without extent. All of them bulge by more than `bulge`.
double light_on_face(const Scene& scene, std::size_t triangle, float bulge) {
    const TracedScene traced(scene);
    const EnvironmentDistribution environment(scene);
    const LightTable lights(traced, environment, EmitterSampling::both);
    const PathIntegrator integrator(traced, lights, nullptr, {});
    const glm::vec3 inwards = -face_normal(scene.meshes[0], triangle);
    double sum = 0.0;
    std::uint64_t rays = 0;
    constexpr int steps = 16;
    for (int i = 1; i < steps; ++i) {
        for (int j = 1; i + j < steps; ++j) {
            const SurfaceHit hit{0, static_cast<std::uint32_t>(triangle), static_cast<float>(i) / steps,
                                 static_cast<float>(j) / steps, 1.0f};
            const SurfacePoint point = traced.surface_point(hit, inwards);
            EXPECT_GT(point.bulge, bulge);
            sum += integrator.exact_direct(point, rays).x;
        }
    }
    return sum;
}

// A lid close above one face of a coarse ball, as wide as the ball, below what bulges over the face. The sun stands
// below the face, but not below the horizon of all its normals: without the lid the bulge is lit, with it nothing is,
// though nothing lies between the sun and the bulge.
TEST(SmoothSurface, LetsNoLightThroughAnotherSurface) {
    constexpr float gap = 1e-3f;
    Scene scene;
    const int grey = add_material(scene, glm::vec3(albedo));
    add_smooth_ball(scene, grey, 1);
    const std::size_t triangle = 0;
    const glm::vec3 normal = face_normal(scene.meshes[0], triangle);
    const glm::vec3 u = glm::normalize(glm::cross(normal, glm::vec3(0.0f, 1.0f, 0.0f))), v = glm::cross(normal, u);
    scene.directional_lights.push_back({"sun", -glm::normalize(u - 0.02f * normal), glm::vec3(1.0f)});
    EXPECT_GT(light_on_face(scene, triangle, 2.0f * gap), 0.1);

    const glm::vec3 centre = normal * (glm::dot(normal, scene.meshes[0].positions[0]) + gap);
    add_quads(scene, grey, {{centre - u - v, centre + u - v, centre + u + v, centre - u + v}});
    EXPECT_EQ(light_on_face(scene, triangle, 2.0f * gap), 0.0);
}

// Scenes in which nothing bulges spare each hit the search. Tilted walls a thousand metres away whose normals are their
// faces' up to rounding do not bulge, alone; one ball of 32768 faces in the scene does.
TEST(SmoothSurface, IsLookedForWhereNormalsTellOfOne) {
    Scene scene;
    const int grey = add_material(scene, glm::vec3(albedo));
    for (int i = 0; i < 32; ++i) {
        const glm::vec3 normal = glm::normalize(glm::vec3(std::sin(i), std::cos(3 * i), std::sin(5 * i)));
        const glm::vec3 u = glm::normalize(glm::cross(normal, glm::vec3(0.6f, 0.0f, 0.8f))), v = glm::cross(normal, u);
        const glm::vec3 centre = 1000.0f * glm::vec3(std::cos(i), 0.1f * static_cast<float>(i), std::sin(7 * i));
        add_quads(scene, grey, {{centre - u - v, centre + u - v, centre + u + v, centre - u + v}});
        if (i % 2 == 0) scene.meshes.back().normals.assign(4, normal);
    }
    EXPECT_FALSE(TracedScene(scene).anything_bulges());
    add_smooth_ball(scene, grey, 6);
    EXPECT_TRUE(TracedScene(scene).anything_bulges());
}

}  // namespace
}  // namespace plumb

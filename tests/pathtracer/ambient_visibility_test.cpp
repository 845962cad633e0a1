// Ambient visibility against closed forms.
#include <limits>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/pathtracer/test_scenes.h"

namespace plumb {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

ReferenceSettings ambient_settings(float radius, Falloff falloff = Falloff::hard, int samples = 256) {
    ReferenceSettings settings = settings_for({"ao", "position"}, samples);
    settings.quantities.ao_radius = radius;
    settings.quantities.ao_falloff = falloff;
    return settings;
}

const std::vector<glm::vec3> wall = {{0, 0, 8}, {0, 0, -8}, {0, 6, -8}, {0, 6, 8}};

// A floor that meets a wall in the plane x = 0.
Scene corner() {
    Scene scene;
    const int grey = add_material(scene, glm::vec3(0.5f));
    add_quads(scene, grey, {floor_quad(10.0f), wall});
    return scene;
}
// Sees nothing but floor, so that every pixel's answer is that of its distance from the wall.
View corner_view() { return view_of({1.5f, 1.2f, 2.0f}, {0.6f, 0.0f, 0.0f}, 0.15f); }

TEST(AmbientVisibility, BesideAFiniteWallIsOneMinusItsViewFactor) {
    const Scene scene = corner();
    const Frame frame = PathTracer(scene).render(corner_view(), ambient_settings(infinity)).frame;
    expect_mean(frame, "ao", [&](int x, int y) {
        const glm::dvec3 position(colour_at(frame.plane("position"), x, y));
        return 1.0 - polygon_irradiance(position, {0, 1, 0}, wall) / glm::pi<double>();
    });
}

// The wall's height h = 6 m at distance a, endless along z: 1 - (1 - a / sqrt(a^2 + h^2)) / 2 (Howell, B-3). The wall
// ends 8 m to either side, which opens less than 0.5 % more.
TEST(AmbientVisibility, BesideALongWallFollowsTheStripFormula) {
    const Scene scene = corner();
    const Frame frame = PathTracer(scene).render(corner_view(), ambient_settings(infinity)).frame;
    double mean = 0.0, expected = 0.0;
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            const double a = frame.plane("position").at(x, y, 0);
            mean += frame.plane("ao").at(x, y);
            expected += 1.0 - 0.5 * (1.0 - a / std::sqrt(a * a + 36.0));
        }
    }
    EXPECT_NEAR(mean / expected, 1.0, 0.01);
}

// A direction with component -w along the wall's normal meets it after a / w. Cosine-weighted directions are uniform
// over the unit disc, where w is one coordinate: obscurance = (1/pi) * integral over w from a/r to 1 of 2 sqrt(1 - w^2)
// g(a/w).
class CornerFalloffs : public testing::TestWithParam<Falloff> {};

TEST_P(CornerFalloffs, WithinARadiusTheWallCountsByItsFalloff) {
    const Scene scene = corner();
    const float radius = 1.5f;
    const Frame frame = PathTracer(scene).render(corner_view(), ambient_settings(radius, GetParam())).frame;
    expect_mean(frame, "ao", [&](int x, int y) {
        const double a = frame.plane("position").at(x, y, 0);
        double obscurance = 0.0;
        constexpr int steps = 2000;  // midpoint rule: error below 1e-5
        const double first = std::min(1.0, a / radius), step = (1.0 - first) / steps;
        for (int i = 0; i < steps; ++i) {
            const double w = first + (i + 0.5) * step, ratio = a / (w * radius);
            const double quadratic = 1.0 - ratio * ratio;
            const double g = GetParam() == Falloff::hard        ? 1.0
                             : GetParam() == Falloff::quadratic ? quadratic
                                                                : quadratic * quadratic * quadratic;
            obscurance += 2.0 * std::sqrt(1.0 - w * w) * g * step;
        }
        return 1.0 - obscurance / glm::pi<double>();
    });
}

INSTANTIATE_TEST_SUITE_P(All, CornerFalloffs, testing::Values(Falloff::hard, Falloff::quadratic, Falloff::cubic));

// Below the centre of a disc of radius r at height h the view factor is r^2 / (r^2 + h^2) (Howell, B-12).
TEST(AmbientVisibility, UnderADiscFollowsItsViewFactor) {
    Scene scene;
    const int grey = add_material(scene, glm::vec3(0.5f));
    add_quads(scene, grey, {floor_quad(10.0f)});
    Mesh disc;
    disc.material = grey;
    const float radius = 0.8f, height = 0.6f;
    constexpr unsigned corners = 2048;  // the polygon's area falls short of the disc's by 1.6e-6
    disc.positions.push_back({0, height, 0});
    for (unsigned i = 0; i < corners; ++i) {
        const float angle = glm::two_pi<float>() * static_cast<float>(i) / corners;
        disc.positions.push_back({radius * std::cos(angle), height, radius * std::sin(angle)});
        disc.triangles.push_back({0, 1 + i, 1 + (i + 1) % corners});
    }
    scene.instances.push_back({"disc", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)});
    scene.meshes.push_back(disc);
    // So narrow a view that all pixels see the centre to within 2 mm.
    const View view = view_of({1.0f, 0.4f, 0.9f}, {0, 0, 0}, 1e-3f);
    const Frame frame = PathTracer(scene).render(view, ambient_settings(infinity)).frame;
    expect_mean(frame, "ao", 1.0 - radius * radius / (radius * radius + height * height));
}

TEST(AmbientVisibility, DoesNotDependOnWhichOtherPlanesAreWanted) {
    const Scene scene = corner();
    const PathTracer tracer(scene);
    for (const Falloff falloff : {Falloff::hard, Falloff::quadratic}) {
        auto settings = ambient_settings(1.0f, falloff, 16);
        const Frame alone = tracer.render(corner_view(), settings).frame;
        settings.quantities.planes = {"ao", "direct", "indirect"};
        const Frame together = tracer.render(corner_view(), settings).frame;
        for (int y = 0; y < alone.height(); ++y) {
            for (int x = 0; x < alone.width(); ++x) {
                EXPECT_EQ(alone.plane("ao").at(x, y), together.plane("ao").at(x, y)) << x << ", " << y;
            }
        }
    }
}

// A plane alone obscures nothing of itself, at any scale and wherever it lies: no ray may start below its own triangle.
TEST(RayOrigin, LeavesItsTriangleAtEveryScaleAndPlace) {
    for (const float scale : {1e-3f, 1.0f, 1e3f}) {
        for (const float offset : {0.0f, 10.0f, 1000.0f}) {
            for (const float angle : {0.0f, 0.3f, 1.1f}) {
                glm::mat4 transform = glm::translate(glm::mat4(1.0f), scale * offset * glm::vec3(1.0f, -0.7f, 0.4f));
                transform = glm::rotate(transform, angle, glm::normalize(glm::vec3(1, 3, 2)));
                transform = glm::scale(transform, glm::vec3(scale));
                Scene scene;
                add_quads(scene, add_material(scene, glm::vec3(0.5f)), {floor_quad(1.0f)}, transform);
                const glm::vec3 eye(transform * glm::vec4(0.2f, 1.5f, 0.5f, 1)),
                    target(transform * glm::vec4(0, 0, 0, 1));
                const glm::vec3 up(transform * glm::vec4(0, 0, -1, 0));
                Camera camera = Camera::look_at("test", eye, target, 0.9f, up);
                camera.near_plane = 1e-3f * scale, camera.far_plane = 100.0f * scale;
                const Frame frame =
                    PathTracer(scene).render(View(camera, 16, 16), ambient_settings(infinity, Falloff::hard, 64)).frame;
                int obscured = 0;
                for (const float value : frame.plane("ao").values()) obscured += value == 1.0f ? 0 : 1;
                EXPECT_EQ(obscured, 0) << "scale " << scale << ", offset " << offset << ", angle " << angle;
            }
        }
    }
}

}  // namespace
}  // namespace plumb

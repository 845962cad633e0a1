// Ambient visibility against closed forms.
#include <limits>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/pathtracer/closed_forms.h"
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

// So narrow a view of the floor's point (x, z) that all pixels see it to within a millimetre; being symmetric, the
// spread errs by its square only.
View view_of_floor_point(float x, float z) { return view_of({x + 0.3f, 0.2f, z + 0.25f}, {x, 0, z}, 1e-3f); }

// Floor, and walls in the planes x = 0 and z = 0, `height` high. They reach 50 m, far beyond every finite radius here.
constexpr float reach = 50.0f;
closed_form::Polygon wall_at_x(double height) {
    return {{0, 0, reach}, {0, 0, -reach}, {0, height, -reach}, {0, height, reach}};
}
closed_form::Polygon wall_at_z(double height) {
    return {{-reach, 0, 0}, {reach, 0, 0}, {reach, height, 0}, {-reach, height, 0}};
}
Scene floor_and(const std::vector<closed_form::Polygon>& polygons) {
    Scene scene;
    const int grey = add_material(scene, glm::vec3(0.5f));
    add_quads(scene, grey, {floor_quad(10.0f)});
    for (const closed_form::Polygon& polygon : polygons) add_polygon(scene, grey, polygon);
    return scene;
}
Scene corner() { return floor_and({wall_at_x(6.0)}); }
View corner_view() { return view_of({1.5f, 1.2f, 2.0f}, {0.6f, 0.0f, 0.0f}, 0.15f); }

// A horizontal disc around (0, height, 0). The polygon's area falls short of the disc's by 1.6e-6.
Scene floor_under_disc(float radius, float height) {
    closed_form::Polygon disc;
    constexpr int corners = 2048;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2.0 * closed_form::pi * i / corners;
        disc.emplace_back(radius * std::cos(angle), height, radius * std::sin(angle));
    }
    return floor_and({disc});
}

double seen_fraction(const glm::dvec3& point, const closed_form::Polygon& polygon) {
    return closed_form::polygon_irradiance(point, {0, 1, 0}, polygon) / closed_form::pi;
}

// Each with every falloff, a radius that cuts through the occluder, one that contains most of it, and none.
class ObscuranceOf : public testing::TestWithParam<std::tuple<Falloff, float>> {
protected:
    using Formula = std::function<double(double radius, Falloff falloff)>;
    static void expect(const Scene& scene, float x, float z, const Formula& obscurance) {
        const auto [falloff, radius] = GetParam();
        const Frame frame =
            PathTracer(scene).render(view_of_floor_point(x, z), ambient_settings(radius, falloff)).frame;
        expect_mean(frame, "ao", 1.0 - obscurance(radius, falloff), fmt::format("at {}, {}", x, z));
    }
};

TEST_P(ObscuranceOf, AHighWallFollowsItsClosedForm) {
    const Scene scene = floor_and({wall_at_x(reach)});
    for (const float a : {0.15f, 0.6f, 1.4f}) {
        expect(scene, a, 0.0f, [&](double radius, Falloff falloff) {
            return std::isinf(radius) ? seen_fraction({a, 0, 0}, wall_at_x(reach))
                                      : closed_form::endless_wall(a, radius, falloff);
        });
    }
}

TEST_P(ObscuranceOf, ALowWallFollowsItsIntegral) {
    constexpr double height = 0.7;
    const Scene scene = floor_and({wall_at_x(height)});
    for (const float a : {0.15f, 0.6f}) {
        expect(scene, a, 0.0f, [&](double radius, Falloff falloff) {
            return std::isinf(radius) ? seen_fraction({a, 0, 0}, wall_at_x(height))
                                      : closed_form::wall_of_height(a, height, radius, falloff);
        });
    }
}

TEST_P(ObscuranceOf, ACornerOfTwoWallsFollowsItsIntegral) {
    const Scene scene = floor_and({wall_at_x(reach), wall_at_z(reach)});
    for (const glm::vec2 at : {glm::vec2(0.3f, 0.3f), glm::vec2(0.2f, 0.9f), glm::vec2(0.85f, 0.7f)}) {
        expect(scene, at.x, at.y, [&](double radius, Falloff falloff) {
            if (!std::isinf(radius)) return closed_form::corner_of_two_walls(at.x, at.y, radius, falloff);
            // Of each wall what is in front of the other one.
            const glm::dvec3 point(at.x, 0, at.y);
            return seen_fraction(point, {{0, 0, reach}, {0, 0, 0}, {0, reach, 0}, {0, reach, reach}}) +
                   seen_fraction(point, {{0, 0, 0}, {reach, 0, 0}, {reach, reach, 0}, {0, reach, 0}});
        });
    }
}

TEST_P(ObscuranceOf, ADiscFollowsItsViewFactorAlsoOffItsAxis) {
    constexpr float disc_radius = 0.6f, height = 0.45f;
    const Scene scene = floor_under_disc(disc_radius, height);
    for (const float a : {0.0f, 0.35f, 0.6f, 1.0f}) {
        expect(scene, a, 0.0f, [&](double radius, Falloff falloff) {
            return closed_form::under_disc(disc_radius, height, a, radius, falloff);
        });
    }
}

INSTANTIATE_TEST_SUITE_P(All, ObscuranceOf,
                         testing::Combine(testing::Values(Falloff::hard, Falloff::quadratic, Falloff::cubic),
                                          testing::Values(0.5f, 0.9f, 2.5f, infinity)),
                         [](const testing::TestParamInfo<std::tuple<Falloff, float>>& test) {
                             const float radius = std::get<1>(test.param);
                             return fmt::format(
                                 "{}{}", to_string(std::get<0>(test.param)),
                                 std::isinf(radius) ? "Everywhere" : fmt::format("Within{:.0f}cm", 100.0f * radius));
                         });

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

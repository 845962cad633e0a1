// Deferred direct light against closed forms and quadrature, pixel by pixel, at the positions and normals of the
// G-buffer.
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "gl_test.h"
#include "light_scenes.h"
#include "rasterizer/environment_light.h"
#include "rasterizer/pipeline.h"

namespace plumb {
namespace {

using DirectLightTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(DirectLightTest);

constexpr double pi = glm::pi<double>();

using Irradiance = std::function<glm::dvec3(const glm::dvec3& point, const glm::dvec3& normal)>;

// Within a few texels of the edges where walls meet, a filtered shadow lookup reaches across to the other wall.
bool is_near_an_edge(const glm::dvec3& p) {
    constexpr double reach = 0.04;
    return (p.x < -2.0 + reach) + (p.y < reach) + (p.z < -2.0 + reach) > 1;
}

// `tolerance` is relative to the brightest pixel for what is dark, and relative to the pixel for what is bright.
void expect_direct(GlContext& context, const Scene& scene, const Irradiance& irradiance, double tolerance,
                   const Method& method = plain_method()) {
    const View view = corner_view();
    const Frame frame = render(context, scene, view, {"position", "normal", "albedo", "direct", "depth"}, method);
    double brightest = 0.0;
    for (const float value : frame.plane("direct").values())
        brightest = std::max(brightest, static_cast<double>(value));
    ASSERT_GT(brightest, 0.0);
    int wrong = 0;
    double worst = 0.0;
    std::string first;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            const glm::dvec3 direct = vector_at(frame.plane("direct"), x, y);
            const glm::dvec3 position = vector_at(frame.plane("position"), x, y);
            glm::dvec3 expected(0.0);
            if (!std::isinf(frame.plane("depth").at(x, y))) {
                if (is_near_an_edge(position)) continue;
                expected = vector_at(frame.plane("albedo"), x, y) / pi *
                           irradiance(position, vector_at(frame.plane("normal"), x, y));
            }
            const double error = glm::length(direct - expected) / (glm::length(expected) + 0.01 * brightest);
            worst = std::max(worst, error);
            if (error > tolerance && wrong++ == 0) {
                first = fmt::format("pixel ({}, {}): {} {} {} instead of {} {} {}", x, y, direct.x, direct.y, direct.z,
                                    expected.x, expected.y, expected.z);
            }
        }
    }
    EXPECT_EQ(wrong, 0) << "worst relative error " << worst << "; first " << first;
}

// Half floats keep 4.9e-4 of a value over the range of one exponent; float positions add some 1e-5.
constexpr double half_float = 1e-3;

TEST_P(DirectLightTest, PointLightFallsWithTheSquareOfTheDistance) {
    Scene scene = make_corner();
    scene.point_lights.push_back({"lamp", {0.3f, 1.5f, 0.2f}, {9.0f, 7.0f, 5.0f}});
    scene.point_lights.push_back({"second", {-1.2f, 0.8f, 1.1f}, {1.0f, 2.0f, 4.0f}});
    expect_direct(
        context(), scene,
        [&](const glm::dvec3& p, const glm::dvec3& n) {
            glm::dvec3 sum(0.0);
            for (const PointLight& light : scene.point_lights) {
                const glm::dvec3 to_light = glm::dvec3(light.position) - p;
                const double d = glm::length(to_light);
                sum += glm::dvec3(light.intensity) * std::max(0.0, glm::dot(n, to_light) / d) / (d * d);
            }
            return sum;
        },
        half_float);
}

TEST_P(DirectLightTest, SpotLightFollowsItsCone) {
    for (const glm::vec2 angles : {glm::vec2(0.3f, 0.7f), glm::vec2(0.5f, 0.5f), glm::vec2(0.9f, 1.4f)}) {
        const float inner = angles.x, outer = angles.y;
        Scene scene = make_corner();
        scene.spot_lights.push_back(
            {"spot", {0.6f, 2.1f, 0.5f}, glm::normalize(glm::vec3(-0.5f, -1.0f, -0.6f)), {20, 15, 10}, inner, outer});
        const SpotLight& light = scene.spot_lights[0];
        SCOPED_TRACE(fmt::format("angles {} to {}", inner, outer));
        // The hard cone's edge falls between pixels: its falloff, a ten-thousandth of the cosine wide, is steep.
        const double cone_width =
            std::max(1e-4, std::cos(static_cast<double>(inner)) - std::cos(static_cast<double>(outer)));
        expect_direct(
            context(), scene,
            [&](const glm::dvec3& p, const glm::dvec3& n) {
                const glm::dvec3 to_light = glm::dvec3(light.position) - p;
                const double d = glm::length(to_light);
                const double cosine = std::max(0.0, glm::dot(n, to_light) / d);
                const double along = -glm::dot(to_light / d, glm::dvec3(light.direction));
                const double cone = std::clamp((along - std::cos(static_cast<double>(outer))) / cone_width, 0.0, 1.0);
                return glm::dvec3(light.intensity) * cosine * cone * cone / (d * d);
            },
            inner == outer ? 1e-2 : half_float);  // the edge of the hard cone is a hundred times steeper
    }
}

// Constant, linear and quadratic terms, each alone and together, for both kinds of lamp.
TEST_P(DirectLightTest, LampsFallOffWithTheirAttenuation) {
    for (const Attenuation& terms :
         {Attenuation{1.0f, 0.0f, 0.0f}, Attenuation{0.0f, 1.0f, 0.0f}, Attenuation{0.5f, 0.7f, 0.3f}}) {
        Scene scene = make_corner();
        const glm::vec3 axis = glm::normalize(glm::vec3(-0.5f, -1.0f, -0.6f));
        scene.point_lights.push_back({"lamp", {0.3f, 1.5f, 0.2f}, {3.0f, 2.0f, 1.0f}, terms});
        scene.spot_lights.push_back({"spot", {0.6f, 2.1f, 0.5f}, axis, {5, 4, 3}, 0.3f, 0.7f, terms});
        SCOPED_TRACE(fmt::format("{} + {} d + {} d^2", terms.constant, terms.linear, terms.quadratic));
        expect_direct(
            context(), scene,
            [&](const glm::dvec3& p, const glm::dvec3& n) {
                const auto irradiance = [&](const glm::vec3& position, const glm::vec3& intensity, double cone) {
                    const glm::dvec3 to_light = glm::dvec3(position) - p;
                    const double d = glm::length(to_light);
                    return cone * glm::dvec3(intensity) * std::max(0.0, glm::dot(n, to_light) / d) /
                           (terms.constant + d * (terms.linear + d * terms.quadratic));
                };
                const PointLight& lamp = scene.point_lights[0];
                const SpotLight& spot = scene.spot_lights[0];
                const double along = glm::dot(glm::normalize(p - glm::dvec3(spot.position)), glm::dvec3(axis));
                const double inner = std::cos(0.3), outer = std::cos(0.7);
                const double cone = std::clamp((along - outer) / (inner - outer), 0.0, 1.0);
                return irradiance(lamp.position, lamp.intensity, 1.0) +
                       irradiance(spot.position, spot.intensity, cone * cone);
            },
            half_float);
    }
}

TEST_P(DirectLightTest, DirectionalLightDependsOnTheCosineOnly) {
    Scene scene = make_corner();
    scene.directional_lights.push_back({"sun", glm::normalize(glm::vec3(-0.4f, -1.0f, -0.7f)), {3.0f, 2.5f, 2.0f}});
    expect_direct(
        context(), scene,
        [&](const glm::dvec3&, const glm::dvec3& n) {
            const DirectionalLight& sun = scene.directional_lights[0];
            return glm::dvec3(sun.irradiance) * std::max(0.0, -glm::dot(n, glm::dvec3(sun.direction)));
        },
        half_float);
}

// Irradiance from a parallelogram by midpoint quadrature: L cos cos / d^2 dA.
glm::dvec3 quadrature(const glm::dvec3& p, const glm::dvec3& n, const glm::dvec3& corner, const glm::dvec3& u,
                      const glm::dvec3& v, const glm::dvec3& radiance, bool both_sides) {
    constexpr int steps = 96;
    const glm::dvec3 area = glm::cross(u, v) / static_cast<double>(steps * steps);
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const glm::dvec3 to_light = corner + (i + 0.5) / steps * u + (j + 0.5) / steps * v - p;
            const double square = glm::dot(to_light, to_light);
            const double facing = -glm::dot(area, to_light);
            sum += std::max(0.0, glm::dot(n, to_light)) * (both_sides ? std::abs(facing) : std::max(0.0, facing)) /
                   (square * square);
        }
    }
    return sum * radiance;
}

// A lamp that some walls' horizons cut through. Quadrature with 96^2 points is good to 1e-3 at a lamp's width; where
// the horizon cuts the lamp, its last strip of cells is in or out as a whole.
void expect_rectangle(GlContext& context, bool both_sides) {
    Scene scene = make_corner();
    Material glow;
    glow.emission = {8.0f, 6.0f, 4.0f};
    glow.two_sided = both_sides;
    scene.materials.push_back(glow);
    const glm::vec3 corner(-0.4f, 1.6f, 0.6f), u(0.9f, 0.2f, 0.0f), v(0.0f, -0.5f, 0.4f);
    add_quad(scene, 2, corner, v, u);
    expect_direct(
        context, scene,
        [&](const glm::dvec3& p, const glm::dvec3& n) {
            // The lamp itself is in the picture; it does not light itself.
            const glm::dvec3 normal = glm::cross(glm::dvec3(v), glm::dvec3(u));
            if (std::abs(glm::dot(glm::normalize(normal), p - glm::dvec3(corner))) < 1e-4) return glm::dvec3(0.0);
            return quadrature(p, n, corner, v, u, glow.emission, both_sides);
        },
        5e-3);
}

TEST_P(DirectLightTest, EmissiveRectangleIsExactToItsFront) { expect_rectangle(context(), false); }
TEST_P(DirectLightTest, EmissiveRectangleShinesFromBothSidesWhereTwoSided) { expect_rectangle(context(), true); }

// A closed bulb of few triangles is lit by its front faces only, of many by clusters; both near a true sphere, whose
// irradiance is pi L (r / d)^2 cos where it is wholly above the horizon.
void expect_ball(GlContext& context, unsigned rings, double tolerance) {
    Scene scene = make_corner();
    Material glow;
    glow.emission = {30.0f, 20.0f, 10.0f};
    scene.materials.push_back(glow);
    const glm::vec3 centre(0.2f, 1.3f, 0.1f);
    constexpr double radius = 0.1;
    Mesh ball = make_ball(rings, static_cast<float>(radius), centre);
    // As much surface as the sphere: what flat facets lack would be an error of the mesh, not of the light.
    double area = 0.0;
    for (const glm::uvec3& t : ball.triangles) {
        area += 0.5 * glm::length(glm::cross(ball.positions[t.y] - ball.positions[t.x],
                                             ball.positions[t.z] - ball.positions[t.x]));
    }
    const auto scale = static_cast<float>(std::sqrt(4.0 * pi * radius * radius / area));
    for (glm::vec3& p : ball.positions) p = centre + scale * (p - centre);
    ball.material = 2;
    scene.instances.push_back({"bulb", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)});
    scene.meshes.push_back(ball);
    expect_direct(
        context, scene,
        [&](const glm::dvec3& p, const glm::dvec3& n) {
            const glm::dvec3 to_centre = glm::dvec3(centre) - p;
            const double d = glm::length(to_centre);
            if (d < 1.5 * radius) return glm::dvec3(0.0);  // the bulb itself
            return pi * glm::dvec3(glow.emission) * (radius * radius) / (d * d) *
                   std::max(0.0, glm::dot(n, to_centre) / d);
        },
        tolerance);
}

// 48 facets make a coarse ball; its silhouette varies by a few percent around the sphere's.
TEST_P(DirectLightTest, ClosedBulbIsLitByItsFrontOnly) { expect_ball(context(), 4, 0.08); }
// Some 58 discs for a fine ball: the power is right, its share in one direction varies by several percent.
TEST_P(DirectLightTest, FineBulbIsGatheredIntoClusters) { expect_ball(context(), 24, 0.1); }

TEST_P(DirectLightTest, ConstantEnvironmentGivesItsRadianceTimesAlbedo) {
    Scene scene = make_corner();
    scene.environment.radiance = {0.5f, 0.75f, 1.25f};
    expect_direct(
        context(), scene,
        [&](const glm::dvec3&, const glm::dvec3&) { return pi * glm::dvec3(scene.environment.radiance); }, half_float);
}

TEST_P(DirectLightTest, EnvironmentIsDimmedByAmbientVisibility) {
    Scene scene = make_corner();
    scene.environment.radiance = {1.0f, 1.0f, 1.0f};
    const View view = corner_view();
    const Frame frame = render(context(), scene, view, {"ao", "albedo", "direct"}, Method());
    double darkest = 1.0;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            const double ao = frame.plane("ao").at(x, y);
            darkest = std::min(darkest, ao);
            const glm::dvec3 expected = ao * vector_at(frame.plane("albedo"), x, y);
            ASSERT_LT(glm::length(vector_at(frame.plane("direct"), x, y) - expected), 2e-3) << x << ", " << y;
        }
    }
    EXPECT_LT(darkest, 0.9);
}

TEST(EnvironmentLight, IrradianceOfASmoothSkyIsItsIntegral) {
    Scene scene;
    Texture sky;  // brighter upwards and to one side, without small features
    sky.width = 64, sky.height = 32, sky.wrap_v = TextureWrap::clamp;
    for (int y = 0; y < sky.height; ++y) {
        for (int x = 0; x < sky.width; ++x) {
            const double polar = pi * (y + 0.5) / sky.height, azimuth = 2.0 * pi * (x + 0.5) / sky.width;
            const double value = 1.0 + 0.8 * std::cos(polar) + 0.3 * std::sin(polar) * std::sin(azimuth);
            for (const double channel : {value, 0.5 * value, 2.0, 1.0})
                sky.texels.push_back(half(static_cast<float>(channel)));
        }
    }
    scene.textures.push_back(sky);
    scene.environment = {{1.0f, 2.0f, 0.5f}, 0, 0.4f};
    const IrradianceCoefficients coefficients = project_irradiance(scene);
    for (const glm::vec3& normal :
         {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0), glm::vec3(0.6f, 0.0f, -0.8f)}) {
        glm::dvec3 expected(0.0);
        constexpr int rows = 200, columns = 400;
        for (int i = 0; i < rows; ++i) {
            for (int j = 0; j < columns; ++j) {
                const double polar = pi * (i + 0.5) / rows, azimuth = 2.0 * pi * (j + 0.5) / columns;
                const glm::vec3 direction(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                          std::sin(polar) * std::sin(azimuth));
                const double solid_angle = std::sin(polar) * (pi / rows) * (2.0 * pi / columns);
                expected += glm::dvec3(scene.environment_radiance(direction)) * solid_angle *
                            std::max(0.0, static_cast<double>(glm::dot(normal, direction)));
            }
        }
        const glm::dvec3 irradiance(irradiance_from(coefficients, normal));
        // This sky has orders 0 and 1 only, up to its texels; quadrature over the clamped cosine is good to 1e-3.
        EXPECT_LT(glm::length(irradiance - expected), 5e-3 * glm::length(expected))
            << irradiance.x << " " << expected.x;
    }
}

}  // namespace
}  // namespace plumb

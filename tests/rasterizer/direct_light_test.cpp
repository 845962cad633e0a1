// Deferred direct light against closed forms and quadrature, pixel by pixel, at the positions and normals of the
// G-buffer.
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "gl_test.h"
#include "rasterizer/environment_light.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/pipeline.h"
#include "ray_caster.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

using DirectLightTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(DirectLightTest);

constexpr double pi = glm::pi<double>();

void add_quad(Scene& scene, int material, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v) {
    Mesh mesh;
    mesh.material = material;
    mesh.positions = {corner, corner + u, corner + u + v, corner + v};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.instances.push_back({"quad", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)});
    scene.meshes.push_back(mesh);
}

// A floor and two walls that see each other but cast no shadows on each other from lights inside.
Scene make_corner() {
    Scene scene;
    scene.name = "corner";
    scene.materials.resize(2);
    scene.materials[0].base_colour = {0.8f, 0.5f, 0.3f};
    scene.materials[1].base_colour = {0.4f, 0.7f, 0.6f};
    add_quad(scene, 0, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    add_quad(scene, 1, {-2, 0, -2}, {4, 0, 0}, {0, 3, 0});
    add_quad(scene, 1, {-2, 0, 2}, {0, 0, -4}, {0, 3, 0});
    return scene;
}

View near_view() { return View(Camera::look_at("near", {1.0f, 1.6f, 1.6f}, {-0.1f, 0.2f, -0.4f}, 0.7f), 80, 60); }
View corner_view() { return View(Camera::look_at("corner", {1.8f, 2.2f, 3.0f}, {-0.5f, 0.6f, -0.8f}, 0.9f), 96, 72); }

Frame render(GlContext& context, const Scene& scene, const View& view, std::vector<std::string> planes,
             const Method& method) {
    Quantities quantities;
    quantities.planes = std::move(planes);
    return Pipeline(context, scene, method, quantities, view.width(), view.height()).render(view).frame;
}

Method plain_method() {
    Method method;
    method.ao.enabled = false;
    method.radiosity.enabled = false;
    return method;
}

glm::dvec3 vector_at(const Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

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
    for (const auto& [inner, outer] : {std::pair{0.3f, 0.7f}, std::pair{0.5f, 0.5f}, std::pair{0.9f, 1.4f}}) {
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

// A ball of `rings` x 2 rings sectors, outwards.
Mesh make_ball(unsigned rings, float radius, const glm::vec3& centre) {
    Mesh ball;
    const unsigned sectors = 2 * rings;
    ball.positions.push_back(centre + glm::vec3(0, radius, 0));
    for (unsigned i = 1; i < rings; ++i) {
        for (unsigned j = 0; j < sectors; ++j) {
            const float theta = glm::pi<float>() * static_cast<float>(i) / static_cast<float>(rings);
            const float phi = glm::two_pi<float>() * static_cast<float>(j) / static_cast<float>(sectors);
            ball.positions.push_back(centre + radius * glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                                 std::sin(theta) * std::sin(phi)));
        }
    }
    ball.positions.push_back(centre - glm::vec3(0, radius, 0));
    const auto at = [&](unsigned i, unsigned j) { return 1 + (i - 1) * sectors + j % sectors; };
    const auto last = static_cast<unsigned>(ball.positions.size()) - 1;
    for (unsigned j = 0; j < sectors; ++j) {
        ball.triangles.push_back({0, at(1, j + 1), at(1, j)});
        for (unsigned i = 1; i + 1 < rings; ++i) {
            ball.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
            ball.triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
        }
        ball.triangles.push_back({at(rings - 1, j), at(rings - 1, j + 1), last});
    }
    return ball;
}

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

// Shadows: light or no light, where a ray says so, except within a few texels of the shadow's edge.
void expect_shadows(GlContext& context, const Scene& scene, const View& view, const glm::dvec3& light, bool directional,
                    int ignored_instance, double blur, const Method& method = plain_method()) {
    const Frame frame = render(context, scene, view, {"position", "normal", "direct", "depth"}, method);
    const RayCaster caster(scene);
    int wrong = 0, lit = 0, dark = 0;
    std::string first;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            if (std::isinf(frame.plane("depth").at(x, y))) continue;
            const glm::dvec3 p = vector_at(frame.plane("position"), x, y), n = vector_at(frame.plane("normal"), x, y);
            const glm::dvec3 to_light = directional ? -light : light - p;
            const glm::dvec3 direction = glm::normalize(to_light);
            if (glm::dot(n, direction) < 0.03) continue;  // grazing: the light has all but gone
            const glm::dvec3 right = glm::normalize(glm::cross(direction, glm::dvec3(0.31, 0.87, 0.39)));
            const glm::dvec3 up = glm::cross(right, direction);
            const glm::dvec3 target = directional ? p + 100.0 * direction : light;
            int blocked = 0;
            constexpr int probes = 9;
            for (int i = 0; i < probes; ++i) {
                // Probes around the point, pressed onto its plane along the light.
                const double angle = 2.0 * pi * i / (probes - 1);
                glm::dvec3 offset = i == 0 ? glm::dvec3(0.0) : blur * (std::cos(angle) * right + std::sin(angle) * up);
                offset -= direction * (glm::dot(n, offset) / glm::dot(n, direction));
                blocked += caster.occluded(p + offset + 1e-5 * n, target, ignored_instance);
            }
            const bool is_lit = frame.plane("direct").at(x, y, 0) > 0.0f;
            if (blocked == probes) ++dark;
            if (blocked == 0) ++lit;
            if ((blocked == 0 && !is_lit) || (blocked == probes && is_lit)) {
                if (wrong++ == 0) first = fmt::format("pixel ({}, {}) is {}", x, y, is_lit ? "lit" : "dark");
            }
        }
    }
    EXPECT_GT(lit, 100);
    EXPECT_GT(dark, 50);
    // A part in a thousand: thin slivers between probes.
    EXPECT_LE(wrong, (lit + dark) / 1000) << lit << " lit, " << dark << " dark; first " << first;
}

Scene make_shadow_scene() {
    Scene scene = make_corner();
    for (const glm::vec3& centre : {glm::vec3(-0.5f, 0.5f, 0.0f), glm::vec3(0.7f, 0.3f, -0.8f)}) {
        Mesh ball = make_ball(8, 0.3f, centre);
        ball.material = 0;
        scene.instances.push_back({"ball", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)});
        scene.meshes.push_back(ball);
    }
    return scene;
}

// Texels measure a few millimetres here; three of them are the reach of bilinear filtering and of the lift.
TEST_P(DirectLightTest, PointLightShadowsAreWhereRaysSay) {
    Scene scene = make_shadow_scene();
    scene.point_lights.push_back({"lamp", {0.4f, 1.9f, 0.9f}, {9.0f, 7.0f, 5.0f}});
    expect_shadows(context(), scene, near_view(), glm::dvec3(scene.point_lights[0].position), false, -1, 0.03);
}

TEST_P(DirectLightTest, SpotLightShadowsAreWhereRaysSay) {
    for (const float outer : {1.05f, 1.5f}) {  // a flat map, a cube
        Scene scene = make_shadow_scene();
        scene.spot_lights.push_back(
            {"spot", {0.4f, 2.6f, 0.9f}, glm::normalize(glm::vec3(-0.3f, -1.0f, -0.5f)), {9, 7, 5}, 0.5f, outer});
        expect_shadows(context(), scene, near_view(), glm::dvec3(scene.spot_lights[0].position), false, -1, 0.03);
    }
}

TEST_P(DirectLightTest, DirectionalShadowsAreWhereRaysSay) {
    Scene scene = make_shadow_scene();
    scene.directional_lights.push_back({"sun", glm::normalize(glm::vec3(-0.4f, -1.0f, -0.6f)), {3, 2, 1}});
    expect_shadows(context(), scene, near_view(), glm::dvec3(scene.directional_lights[0].direction), true, -1, 0.03);
}

TEST_P(DirectLightTest, EmitterCastsTheShadowOfItsCentreAndNoneOfItsOwn) {
    const Scene scene = make_cornell();
    const glm::dvec3 centre(0.278, 0.5483, 0.2795);
    const View view(scene.cameras[0], 80, 80);
    expect_shadows(context(), scene, view, centre, false, 5, 0.012);
}

TEST_P(DirectLightTest, MoreSamplePointsSoftenTheShadow) {
    const Scene scene = make_cornell();
    const View view(scene.cameras[0], 64, 64);
    const auto levels = [&](int samples) {
        Method method = plain_method();
        method.direct.shadow.emitter_samples = samples;
        method.direct.shadow.emitter_size = 256;
        return render(context(), scene, view, {"direct"}, method).plane("direct");
    };
    const Image hard = levels(1), soft = levels(16);
    int partly = 0;
    double hard_sum = 0.0, soft_sum = 0.0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            hard_sum += hard.at(x, y), soft_sum += soft.at(x, y);
            partly +=
                hard.at(x, y) > 0.0f && soft.at(x, y) < 0.9f * hard.at(x, y) && soft.at(x, y) > 0.1f * hard.at(x, y);
        }
    }
    EXPECT_GT(partly, 20);
    // A penumbra takes about as much as it gives.
    EXPECT_NEAR(soft_sum / hard_sum, 1.0, 0.1);
}

TEST_P(DirectLightTest, MaskedHolesLetLightThrough) {
    Scene scene = make_corner();
    Texture stripes;
    stripes.width = 4, stripes.height = 1, stripes.wrap_u = stripes.wrap_v = TextureWrap::clamp;
    for (int x = 0; x < 4; ++x) {
        for (int k = 0; k < 4; ++k) stripes.texels.push_back(half(x < 2 ? 1.0f : 0.0f));
    }
    scene.textures.push_back(stripes);
    Material mask;
    mask.alpha_mask = true;
    mask.base_colour_texture = 0;
    scene.materials.push_back(mask);
    add_quad(scene, 2, {-0.8f, 0.7f, 0.6f}, {1.4f, 0, 0}, {0, 0, -1.2f});
    scene.meshes.back().uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    scene.point_lights.push_back({"lamp", {0.1f, 2.4f, 0.3f}, {9.0f, 7.0f, 5.0f}});
    expect_shadows(context(), scene, near_view(), glm::dvec3(scene.point_lights[0].position), false, -1, 0.03);
}

TEST_P(DirectLightTest, SecondLayerIsLitAsTheFirstWouldBe) {
    // The same wall seen freely and through a pane: its light must not depend on the layer that holds it.
    Scene scene = make_corner();
    scene.point_lights.push_back({"lamp", {-0.3f, 1.5f, 0.2f}, {9.0f, 7.0f, 5.0f}});
    const View view = corner_view();
    const Frame free = render(context(), scene, view, {"direct"}, plain_method());
    Scene behind = scene;
    // Close to the camera, hides the whole view, and too far from the lamp's side to shade anything that is seen.
    const glm::mat4& camera = view.camera().world_from_camera;
    const auto world = [&](float x, float y, float z) { return glm::vec3(camera * glm::vec4(x, y, z, 1.0f)); };
    add_quad(behind, 0, world(-0.4f, -0.4f, -0.3f), world(0.4f, -0.4f, -0.3f) - world(-0.4f, -0.4f, -0.3f),
             world(-0.4f, 0.4f, -0.3f) - world(-0.4f, -0.4f, -0.3f));
    const Frame hidden = render(context(), behind, view, {"layer2.direct"}, plain_method());
    int different = 0;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            const glm::dvec3 a = vector_at(free.plane("direct"), x, y),
                             b = vector_at(hidden.plane("layer2.direct"), x, y);
            different += glm::length(a - b) > 2e-3 * glm::length(a);
        }
    }
    EXPECT_EQ(different, 0);
}

}  // namespace
}  // namespace plumb

// Highlights of lamps and suns, pixel by pixel against the reflectance written out, at the positions, normals and lobes
// of the G-buffer.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "gl_test.h"
#include "light_scenes.h"
#include "ray_caster.h"

namespace plumb {
namespace {

constexpr double pi = std::numbers::pi;

// A corner with a lobe of its own on each side, and a ball of which some is seen edge-on.
Scene make_glossy_scene() {
    Scene scene = make_corner();
    scene.materials.resize(4);
    scene.materials[0].dielectric_reflectance = 0.04f, scene.materials[0].roughness = 0.35f;
    scene.materials[1].metallic = 1.0f, scene.materials[1].roughness = 0.5f;
    scene.materials[2].metallic = 1.0f, scene.materials[2].roughness = 0.01f;  // a mirror shows no lamp
    scene.materials[3].metallic = 0.5f, scene.materials[3].roughness = 0.7f;
    scene.materials[3].dielectric_reflectance = 0.08f;
    scene.meshes[2].material = 2;
    Mesh ball = make_ball(12, 0.5f, {0.3f, 0.6f, -0.2f});
    for (const glm::vec3& p : ball.positions) ball.normals.push_back(glm::normalize(p - glm::vec3(0.3f, 0.6f, -0.2f)));
    ball.material = 3;
    scene.instances.push_back({"ball", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)});
    scene.meshes.push_back(ball);
    return scene;
}

struct LobeSample {
    glm::dvec3 f0;
    double f90, roughness;
};

// Of the light that arrives against the unit vector `i` with the irradiance `perpendicular` on a surface that faces it:
// Trowbridge and Reitz' distribution, Smith's masking of correlated heights, Schlick's Fresnel term.
glm::dvec3 reflected_light(const LobeSample& lobe, const glm::dvec3& shading_normal, const glm::dvec3& o,
                           const glm::dvec3& i, const glm::dvec3& perpendicular) {
    const double alpha = lobe.roughness * lobe.roughness;
    if (alpha < 1e-3 || glm::dot(shading_normal, i) <= 0.0) return glm::dvec3(0.0);
    // A viewer below the horizon, as smooth normals have it at outlines, stands on it.
    const double lean = glm::dot(shading_normal, o);
    const glm::dvec3 n = lean >= 0.0 ? shading_normal : glm::normalize(shading_normal - lean * o);
    const double n_i = glm::dot(n, i), n_o = std::max(glm::dot(n, o), 0.0);
    if (n_i <= 0.0) return glm::dvec3(0.0);
    const glm::dvec3 h = glm::normalize(o + i);
    const double n_h = glm::dot(n, h), o_h = glm::dot(o, h), a2 = alpha * alpha;
    const double distribution = a2 / (pi * std::pow(n_h * n_h * (a2 - 1.0) + 1.0, 2.0));
    // G2 / (4 n.o n.i), of which n.o = 0 leaves a limit.
    const double masking =
        0.5 / (n_o * std::sqrt(a2 + (1.0 - a2) * n_i * n_i) + n_i * std::sqrt(a2 + (1.0 - a2) * n_o * n_o));
    const glm::dvec3 fresnel = lobe.f0 + (glm::dvec3(lobe.f90) - lobe.f0) * std::pow(1.0 - o_h, 5.0);
    return distribution * masking * n_i * fresnel * perpendicular;
}

// All lights of a scene, none of which casts a shadow.
glm::dvec3 highlights(const Scene& scene, const LobeSample& lobe, const glm::dvec3& p, const glm::dvec3& n,
                      const glm::dvec3& eye) {
    const glm::dvec3 o = glm::normalize(eye - p);
    glm::dvec3 sum(0.0);
    const auto add = [&](const glm::dvec3& to_light, const glm::dvec3& perpendicular) {
        sum += reflected_light(lobe, n, o, to_light, perpendicular);
    };
    const auto falloff = [](const Attenuation& terms, double d) {
        return 1.0 / (terms.constant + d * (terms.linear + d * terms.quadratic));
    };
    for (const PointLight& lamp : scene.point_lights) {
        const glm::dvec3 to_light = glm::dvec3(lamp.position) - p;
        const double d = glm::length(to_light);
        add(to_light / d, falloff(lamp.attenuation, d) * glm::dvec3(lamp.intensity));
    }
    for (const SpotLight& spot : scene.spot_lights) {
        const glm::dvec3 to_light = glm::dvec3(spot.position) - p;
        const double d = glm::length(to_light), along = -glm::dot(to_light / d, glm::dvec3(spot.direction));
        const double outer = std::cos(static_cast<double>(spot.outer_angle)),
                     inner = std::cos(static_cast<double>(spot.inner_angle));
        const double cone = std::clamp((along - outer) / (inner - outer), 0.0, 1.0);
        add(to_light / d, cone * cone * falloff(spot.attenuation, d) * glm::dvec3(spot.intensity));
    }
    for (const DirectionalLight& sun : scene.directional_lights)
        add(-glm::dvec3(sun.direction), glm::dvec3(sun.irradiance));
    return sum;
}

// Whether something may stand between a surface and a sun, or reach into the shadow lookups around it.
bool may_be_shadowed(const RayCaster& caster, const Scene& scene, const glm::dvec3& p, const glm::dvec3& n) {
    constexpr double reach = 0.08;  // three texels of a map of 256^2 over 7 m
    const glm::dvec3 across = glm::normalize(glm::cross(n, glm::dvec3(0.31, 0.87, 0.39))),
                     along = glm::cross(n, across);
    for (const DirectionalLight& sun : scene.directional_lights) {
        if (glm::dot(n, glm::dvec3(sun.direction)) >= 0.0) continue;
        for (const glm::dvec2& step :
             {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
            const glm::dvec3 from = p + reach * (step.x * across + step.y * along) + 1e-3 * n;
            if (caster.occluded(from, from - 100.0 * glm::dvec3(sun.direction))) return true;
        }
    }
    return false;
}

struct LampCase {
    const char* name;
    Scene scene;
};

std::vector<LampCase> lamp_cases() {
    std::vector<LampCase> cases(4, {"", make_glossy_scene()});
    const PointLight lamp{"lamp", {0.6f, 1.6f, 0.9f}, {9.0f, 7.0f, 5.0f}};
    const SpotLight spot{"spot", {0.6f, 2.1f, 0.9f}, glm::normalize(glm::vec3(-0.3f, -1.0f, -0.7f)), {20, 15, 10}, 0.3f,
                         0.8f};
    const DirectionalLight sun{"sun", glm::normalize(glm::vec3(-0.3f, -0.8f, -0.5f)), {3.0f, 2.5f, 2.0f}};
    cases[0].name = "a lamp", cases[0].scene.point_lights = {lamp};
    cases[1].name = "a spot light with other falloffs", cases[1].scene.spot_lights = {spot};
    cases[1].scene.spot_lights[0].attenuation = {0.5f, 0.7f, 0.3f};
    cases[2].name = "a sun", cases[2].scene.directional_lights = {sun};
    cases[3].name = "two of each";
    for (const float shift : {0.0f, 0.7f}) {
        cases[3].scene.point_lights.push_back(lamp), cases[3].scene.point_lights.back().position.x -= shift;
        cases[3].scene.spot_lights.push_back(spot), cases[3].scene.spot_lights.back().position.z -= shift;
        cases[3].scene.directional_lights.push_back(sun);
    }
    return cases;
}

// Through EGL alone: what takes time is compiling shaders, and both compile the same.
TEST(LampHighlights, AgreeWithTheReflectanceOfEachLobe) {
    GlContext& context = test_context(GlBackend::egl);
    const View view = corner_view();
    Method method = plain_method();
    method.reflections.enabled = true;
    method.direct.shadow.lamps = false;
    method.direct.shadow.map_size = 256;
    method.gbuffer.normal_format = NormalFormat::rgb32f;
    for (const LampCase& c : lamp_cases()) {
        SCOPED_TRACE(c.name);
        const Frame frame =
            render(context, c.scene, view, {"reflection.lamps", "position", "normal", "specular", "roughness", "depth"},
                   method);
        // f90, the fourth channel of `specular`, is not among what a frame holds: it is the material's.
        const auto f90_at = [&](int x, int y) {
            const glm::dvec3 f0 = vector_at(frame.plane("specular"), x, y);
            for (const Material& material : c.scene.materials) {
                const SurfaceSample sample = c.scene.surface(material, {0.0f, 0.0f});
                if (glm::length(glm::dvec3(sample.specular_f0) - f0) < 2e-3)
                    return static_cast<double>(sample.specular_f90.x);
            }
            ADD_FAILURE() << "an f0 of " << f0.x << " " << f0.y << " " << f0.z << " belongs to no material";
            return 0.0;
        };
        const RayCaster caster(c.scene);
        int compared = 0, bright = 0, wrong = 0, shadowed = 0;
        double brightest = 0.0;
        for (const float value : frame.plane("reflection.lamps").values())
            brightest = std::max(brightest, static_cast<double>(value));
        std::string first;
        for (int y = 0; y < view.height(); ++y) {
            for (int x = 0; x < view.width(); ++x) {
                const glm::dvec3 found = vector_at(frame.plane("reflection.lamps"), x, y);
                if (std::isinf(frame.plane("depth").at(x, y))) {
                    EXPECT_EQ(found, glm::dvec3(0.0));
                    continue;
                }
                const glm::dvec3 p = vector_at(frame.plane("position"), x, y),
                                 n = vector_at(frame.plane("normal"), x, y);
                if (may_be_shadowed(caster, c.scene, p, n)) {
                    ++shadowed;
                    continue;
                }
                const LobeSample lobe{vector_at(frame.plane("specular"), x, y), f90_at(x, y),
                                      frame.plane("roughness").at(x, y)};
                const glm::dvec3 expected = highlights(c.scene, lobe, p, n, glm::dvec3(view.camera().position()));
                ++compared;
                bright += expected.y > 0.05 * brightest;
                // Float positions are good to 1e-6 m, so that half vectors are to some 1e-6 radians, against a lobe of
                // 0.12; half a part in a thousand of f90, a half float, where f0 is known.
                const double error = glm::length(found - expected);
                if (error > 1e-3 * glm::length(expected) + 1e-5 * brightest && wrong++ == 0) {
                    first = fmt::format("pixel ({}, {}): {} {} {} instead of {} {} {}", x, y, found.x, found.y, found.z,
                                        expected.x, expected.y, expected.z);
                }
            }
        }
        EXPECT_EQ(wrong, 0) << "of " << compared << "; first " << first;
        EXPECT_GT(compared, 3000);
        EXPECT_GT(bright, 50);
        EXPECT_LT(shadowed, compared / 2);
    }
}

}  // namespace
}  // namespace plumb

// Shadows of the rasterizer held against rays.
#pragma once

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "light_scenes.h"
#include "ray_caster.h"

namespace plumb {

// Pixels that rays call wholly lit or wholly dark, and how many of them the rasterizer has otherwise.
struct ShadowCount {
    int lit = 0, dark = 0, wrong = 0;
    std::string first;  // of the wrong ones
};

// Light or no light, where a ray says so, except within `blur` metres of the shadow's edge.
inline ShadowCount count_shadows(GlContext& context, const Scene& scene, const View& view, const glm::dvec3& light,
                                 bool directional, int ignored_instance, double blur, const Method& method) {
    constexpr double pi = glm::pi<double>();
    const Frame frame = render(context, scene, view, {"position", "normal", "direct", "depth"}, method);
    const RayCaster caster(scene);
    ShadowCount count;
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
            if (blocked == probes) ++count.dark;
            if (blocked == 0) ++count.lit;
            if ((blocked == 0 && !is_lit) || (blocked == probes && is_lit)) {
                if (count.wrong++ == 0) {
                    count.first = fmt::format("pixel ({}, {}) is {}", x, y, is_lit ? "lit" : "dark");
                }
            }
        }
    }
    return count;
}

inline void expect_shadows(GlContext& context, const Scene& scene, const View& view, const glm::dvec3& light,
                           bool directional, int ignored_instance, double blur, const Method& method = plain_method()) {
    const ShadowCount count = count_shadows(context, scene, view, light, directional, ignored_instance, blur, method);
    EXPECT_GT(count.lit, 100);
    EXPECT_GT(count.dark, 50);
    // A part in a thousand: thin slivers between probes.
    EXPECT_LE(count.wrong, (count.lit + count.dark) / 1000)
        << count.lit << " lit, " << count.dark << " dark; first " << count.first;
}

// Two balls in a corner.
inline Scene make_shadow_scene() {
    Scene scene = make_corner();
    for (const glm::vec3& centre : {glm::vec3(-0.5f, 0.5f, 0.0f), glm::vec3(0.7f, 0.3f, -0.8f)}) {
        Mesh ball = make_ball(8, 0.3f, centre);
        ball.material = 0;
        scene.instances.push_back({"ball", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)});
        scene.meshes.push_back(ball);
    }
    return scene;
}

}  // namespace plumb

// A room that every kind of light can shine into, one by one or all together.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/pathtracer/test_scenes.h"
#include "tests/pathtracer/z_test.h"

namespace plumb {

enum class Sky { none, constant, image };

// Which lights are on; all are there always, so that the geometry is the same. `brightness` multiplies all of them.
struct Lit {
    bool point = false, spot = false, sun = false, panel = false;
    Sky sky = Sky::none;
    float brightness = 1.0f;
};
constexpr Lit everything{true, true, true, true, Sky::constant};

// A coloured room with a gloss over its walls, open towards +Z.
inline Scene lit_room(const Lit& lit, float sun_radius = 0.0f) {
    const glm::vec3 unit(lit.brightness);
    Scene scene;
    const int walls = add_material(scene, {0.7f, 0.5f, 0.3f});
    scene.materials[0].dielectric_reflectance = 0.04f, scene.materials[0].roughness = 0.5f;
    const int panel =
        add_material(scene, glm::vec3(0.2f), lit.panel ? glm::vec3(5.0f, 4.0f, 3.0f) * unit : glm::vec3(0));
    auto quads = room_quads();
    quads.pop_back();
    add_quads(scene, walls, quads);
    add_quads(scene, panel, {{{-0.3f, 0.9f, -0.3f}, {0.3f, 0.9f, -0.3f}, {0.3f, 0.9f, 0.3f}, {-0.3f, 0.9f, 0.3f}}});
    if (lit.point) scene.point_lights.push_back({"point", {0.5f, -0.2f, 0.3f}, glm::vec3(0.8f, 0.7f, 0.2f) * unit});
    if (lit.spot) {
        scene.spot_lights.push_back(
            {"spot", {-0.4f, 0.3f, 0.5f}, glm::normalize(glm::vec3(0.5f, -1, -1)), 2.0f * unit, 0.3f, 0.9f});
    }
    if (lit.sun) {
        scene.directional_lights.push_back(
            {"sun", glm::normalize(glm::vec3(0.2f, -0.4f, -1)), 1.5f * unit, sun_radius});
    }
    if (lit.sky == Sky::image) add_uneven_sky(scene);
    if (lit.sky != Sky::none) scene.environment.radiance = glm::vec3(0.3f, 0.4f, 0.6f) * unit;
    return scene;
}
inline View room_view(int size = 8) { return view_of({0.2f, 0.1f, 3.5f}, {0, 0, 0}, 0.6f, size); }

// Where lights are sampled, as everywhere with anti-aliasing, one is chosen for all, and the sum comes out on average.
// The sun has a disc here.
inline void expect_superposition(const std::vector<std::string>& planes, int bounces, int samples,
                                 Sky sky = Sky::constant) {
    const View view = room_view(4);
    Lit with_all = everything;
    with_all.sky = sky;
    const std::vector<Lit> alone = {{.point = true}, {.spot = true}, {.sun = true}, {.panel = true}, {.sky = sky}};
    std::map<std::string, Replicates> together, summed;
    auto settings = settings_for(planes, samples, bounces);
    settings.antialias = true;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        settings.seed = 100 + seed;
        const Scene scene = lit_room(with_all, 0.1f);
        const Frame all = PathTracer(scene).render(view, settings).frame;
        std::map<std::string, Image> sums;
        for (const std::string& plane : planes) {
            together[plane].add(all.plane(plane));
            sums[plane] = Image(view.width(), view.height(), 3);
        }
        for (std::size_t i = 0; i < alone.size(); ++i) {
            settings.seed = 1000 * (i + 1) + seed;
            const Scene part = lit_room(alone[i], 0.1f);
            const Frame frame = PathTracer(part).render(view, settings).frame;
            for (const std::string& plane : planes) {
                const auto from = frame.plane(plane).values();
                for (std::size_t v = 0; v < from.size(); ++v) sums.at(plane).values()[v] += from[v];
            }
        }
        for (const std::string& plane : planes) summed[plane].add(sums.at(plane));
    }
    for (const std::string& plane : planes) expect_agreement(together.at(plane), summed.at(plane), plane);
}

}  // namespace plumb

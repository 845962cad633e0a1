// Scenes, views and helpers that the tests of direct light share.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/constants.hpp>

#include "rasterizer/gl_context.h"
#include "rasterizer/pipeline.h"
#include "scenes/scene.h"

namespace plumb {

inline void add_quad(Scene& scene, int material, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v) {
    Mesh mesh;
    mesh.material = material;
    mesh.positions = {corner, corner + u, corner + u + v, corner + v};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.instances.push_back({"quad", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)});
    scene.meshes.push_back(mesh);
}

// A floor and two walls that see each other but cast no shadows on each other from lights inside.
inline Scene make_corner() {
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

inline View near_view() {
    return View(Camera::look_at("near", {1.0f, 1.6f, 1.6f}, {-0.1f, 0.2f, -0.4f}, 0.7f), 80, 60);
}
inline View corner_view() {
    return View(Camera::look_at("corner", {1.8f, 2.2f, 3.0f}, {-0.5f, 0.6f, -0.8f}, 0.9f), 96, 72);
}

inline Frame render(GlContext& context, const Scene& scene, const View& view, std::vector<std::string> planes,
                    const Method& method) {
    Quantities quantities;
    quantities.planes = std::move(planes);
    return Pipeline(context, scene, method, quantities, view.width(), view.height()).render(view).frame;
}

inline Method plain_method() {
    Method method;
    method.ao.enabled = false;
    method.radiosity.enabled = false;
    return method;
}

// Lights without shadows.
inline Method lamp_method(LocalLights local_lights, float threshold = 1.0f / 256.0f) {
    Method method = plain_method();
    method.direct.local_lights = local_lights;
    method.direct.volume_threshold = threshold;
    method.direct.shadow.lamps = false;
    return method;
}

inline glm::dvec3 vector_at(const Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

// A ball of `rings` x 2 rings sectors, outwards.
inline Mesh make_ball(unsigned rings, float radius, const glm::vec3& centre) {
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

// A corner, two balls, and panes before them, so that two layers are there nearly everywhere.
inline Scene make_layered_scene() {
    Scene scene = make_corner();
    for (const glm::vec3& centre : {glm::vec3(-0.5f, 0.5f, 0.0f), glm::vec3(0.7f, 0.3f, -0.8f)}) {
        Mesh ball = make_ball(8, 0.3f, centre);
        scene.instances.push_back({"ball", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)});
        scene.meshes.push_back(ball);
    }
    add_quad(scene, 1, {-0.5f, 0.3f, 1.0f}, {1.5f, 0.0f, 0.3f}, {0.0f, 1.2f, 0.0f});
    return scene;
}

}  // namespace plumb

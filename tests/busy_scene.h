// A small scene in which everything that a method has a parameter for is to be found: lamps of all kinds, a sun, an
// emissive surface, an environment with an image, glossy and matt surfaces, things one behind the other, and things
// that move, the emissive surface among them.
#pragma once

#include <cmath>

#include "rasterizer/moment.h"
#include "scenes/scene.h"

namespace plumb {

inline Scene make_busy_scene() {
    Scene scene;
    scene.name = "busy";
    const auto material = [&](const glm::vec3& colour, float metallic, float roughness) {
        Material made;
        made.base_colour = colour, made.metallic = metallic, made.roughness = roughness;
        scene.materials.push_back(made);
        return static_cast<int>(scene.materials.size()) - 1;
    };
    const auto quad = [&](const char* name, int of, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v) {
        Mesh mesh;
        mesh.material = of;
        mesh.positions = {corner, corner + u, corner + u + v, corner + v};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        scene.instances.push_back({name, static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)});
        scene.meshes.push_back(mesh);
    };
    const auto moves = [&](const glm::vec3& along, float turn, const glm::vec3& axis) {
        Motion& motion = scene.instances.back().motion;
        motion.interpolation = MotionInterpolation::linear;
        const Mesh& mesh = scene.meshes.back();
        motion.pivot = 0.5f * (mesh.positions[0] + mesh.positions[2]);
        motion.keys = {{.time = 0.0f}, {.time = 1.0f, .translation = along, .rotation = glm::angleAxis(turn, axis)}};
    };
    const int gloss = material({0.8f, 0.7f, 0.6f}, 0.8f, 0.3f), red = material({0.8f, 0.2f, 0.1f}, 0.0f, 0.9f),
              blue = material({0.2f, 0.3f, 0.8f}, 0.0f, 0.8f), glow = material({0.0f, 0.0f, 0.0f}, 0.0f, 1.0f);
    scene.materials[static_cast<std::size_t>(glow)].emission = {6.0f, 5.0f, 4.0f};
    scene.materials[static_cast<std::size_t>(red)].dielectric_reflectance = 0.04f;
    quad("floor", gloss, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    quad("back wall", blue, {-2, 0, -2}, {4, 0, 0}, {0, 3, 0});
    quad("left wall", red, {-2, 0, 2}, {0, 0, -4}, {0, 3, 0});
    quad("screen", red, {-0.9f, 0.0f, 0.3f}, {0.8f, 0.0f, -0.2f}, {0.0f, 0.9f, 0.0f});
    quad("board", blue, {0.1f, 0.1f, -0.5f}, {0.9f, 0.0f, 0.3f}, {0.0f, 1.2f, 0.0f});
    moves({0.4f, 0.1f, 0.3f}, 0.9f, {0.0f, 1.0f, 0.0f});
    quad("glow", glow, {-0.5f, 2.2f, -0.6f}, {0.7f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.7f});
    moves({0.5f, -0.2f, 0.2f}, 0.5f, {0.0f, 0.0f, 1.0f});

    scene.point_lights.push_back({"lamp", {0.9f, 1.6f, 0.8f}, {3.0f, 2.0f, 1.0f}});
    scene.spot_lights.push_back(
        {"narrow", {-1.2f, 2.0f, 1.2f}, glm::normalize(glm::vec3(0.6f, -0.8f, -0.7f)), {4.0f, 4.0f, 6.0f}, 0.2f, 0.5f});
    scene.spot_lights.push_back(
        {"wide", {1.5f, 1.0f, -0.5f}, glm::normalize(glm::vec3(-0.8f, -0.3f, 0.2f)), {1.0f, 2.0f, 1.0f}, 0.8f, 1.3f});
    scene.directional_lights.push_back({"sun", glm::normalize(glm::vec3(-0.4f, -1.0f, -0.6f)), {1.0f, 1.0f, 0.9f}});
    Texture sky;
    sky.name = "sky", sky.width = 16, sky.height = 8;
    for (int i = 0; i < sky.width * sky.height; ++i) {
        const int column = i % sky.width, row = i / sky.width;
        const float height = 1.0f - static_cast<float>(row) / 8.0f;
        const float across = 0.5f + 0.5f * std::cos(0.4f * static_cast<float>(column));
        for (const float value : {height * across, 0.5f * height, 0.3f + 0.3f * across, 1.0f})
            sky.texels.emplace_back(value);
    }
    scene.environment = {.radiance = glm::vec3(0.5f), .texture = static_cast<int>(scene.textures.size())};
    scene.textures.push_back(std::move(sky));
    return scene;
}

// The scene seen from a camera that moves, too.
inline Moment busy_moment(int frame, int width, int height) {
    const float time = 0.2f + 0.05f * static_cast<float>(frame);
    const Camera camera = Camera::look_at("busy", {1.9f + 0.5f * time, 1.7f, 2.6f}, {-0.4f, 0.7f, -0.6f}, 0.9f);
    return {View(camera, width, height), time};
}

inline FrameRequest busy_frame(int frame, int width, int height) {
    return {.now = busy_moment(frame, width, height),
            .previous = busy_moment(frame - 1, width, height),
            .next = busy_moment(frame + 1, width, height)};
}

}  // namespace plumb

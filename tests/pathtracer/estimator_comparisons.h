// Ways of rendering that must have the same expectation, and scenes where they go about it very differently. What is
// compared in every run is listed in estimators_agree_test.cpp, what takes longer in estimators_agree_slow_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/pathtracer/test_scenes.h"
#include "tests/pathtracer/z_test.h"

namespace plumb {

// A scene and a view of few pixels.
struct Setting {
    std::string name;
    Scene scene;
    View view;
};

inline View small_view(const glm::vec3& eye, const glm::vec3& target, float field_of_view = 0.6f) {
    return view_of(eye, target, field_of_view, 4);
}

// A coloured room under a wide square light that shines downwards, with a box's lid in it.
inline Setting room() {
    Scene scene;
    add_quads(scene, add_material(scene, {0.7f, 0.5f, 0.3f}), room_quads());
    add_quads(scene, add_material(scene, glm::vec3(0.3f), glm::vec3(5.0f), false),
              {{{-0.7f, 0.8f, -0.7f}, {0.7f, 0.8f, -0.7f}, {0.7f, 0.8f, 0.7f}, {-0.7f, 0.8f, 0.7f}}});
    add_quads(scene, 0, {floor_quad(0.3f, -0.5f)});
    return {"Room", std::move(scene), small_view({0, 0, 0.9f}, {0.1f, -0.7f, -0.8f}, 0.9f)};
}

// A floor beside a low wall under an uneven sky with a bright spot.
inline Setting open_air() {
    Scene scene;
    const int grey = add_material(scene, {0.4f, 0.5f, 0.6f});
    add_quads(scene, grey, {floor_quad(10.0f), {{0, 0, 8}, {0, 0, -8}, {0, 1, -8}, {0, 1, 8}}});
    add_uneven_sky(scene);
    return {"OpenAir", std::move(scene), small_view({1.0f, 0.8f, 1.5f}, {0.4f, 0.0f, 0.0f})};
}

// A light that few directions meet: a thousandth of the sky.
inline Setting small_light() {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.6f)), {floor_quad(10.0f)});
    add_quads(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(300.0f)), {floor_quad(0.03f, 1.0f)});
    return {"SmallLight", std::move(scene), small_view({0.3f, 0.6f, 1.0f}, {0.1f, 0.0f, 0.1f})};
}

// A light that stands on the floor, seen from the floor around its edge: near it directions are the better choice by
// far, away from it points are.
inline Setting glancing_light() {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.6f)), {floor_quad(10.0f)});
    add_quads(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(2.0f)),
              {{{0, 0, 1}, {0, 0, -1}, {0, 0.5f, -1}, {0, 0.5f, 1}}});
    return {"GlancingLight", std::move(scene), small_view({0.9f, 0.7f, 0.6f}, {0.6f, 0.0f, 0.3f}, 0.4f)};
}

// The room with a gloss over its diffuse walls and a lid of rough metal.
inline Setting glossy_room() {
    Setting setting = room();
    setting.name = "GlossyRoom";
    Material& walls = setting.scene.materials[0];
    walls.dielectric_reflectance = 0.04f, walls.roughness = 0.6f;
    const int metal = add_material(setting.scene, {0.9f, 0.7f, 0.4f});
    setting.scene.materials[static_cast<std::size_t>(metal)].metallic = 1.0f;
    setting.scene.materials[static_cast<std::size_t>(metal)].roughness = 0.5f;
    setting.scene.meshes.back().material = metal;
    return setting;
}

inline Setting room_with_a_pane() {
    Setting setting = room();
    setting.name = "RoomWithAPane";
    const int pane = add_material(setting.scene, glm::vec3(0.2f));
    setting.scene.materials[static_cast<std::size_t>(pane)].transmission = {0.3f, 0.6f, 0.7f};
    add_quads(setting.scene, pane, {floor_quad(0.8f, 0.2f)});
    return setting;
}

// A coarse ball with the normals of a sphere, at its terminator under a near lamp, where light comes to the bulges
// of faces that do not see it. `with_gloss`: also by its specular lobe.
inline Setting faceted_ball(bool with_gloss = false) {
    Scene scene;
    add_smooth_ball(scene, add_material(scene, glm::vec3(0.6f)), 1);
    if (with_gloss) scene.materials[0].dielectric_reflectance = 0.04f, scene.materials[0].roughness = 0.4f;
    add_quads(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(8.0f)),
              {{{2.0f, -0.5f, -0.5f}, {2.0f, -0.5f, 0.5f}, {2.0f, 0.5f, 0.5f}, {2.0f, 0.5f, -0.5f}}});
    add_quads(scene, add_material(scene, glm::vec3(0.5f)), {floor_quad(5.0f, -1.0f)});
    return {with_gloss ? "GlossyFacetedBall" : "FacetedBall", std::move(scene),
            small_view({1.2f, 0.6f, 3.0f}, {0.66f, 0.1f, 0.74f}, 0.12f)};
}

// How to render; by default `settings` as they are changed here. Adding one is one line.
struct Way {
    std::string name;
    std::function<void(ReferenceSettings&)> change = [](ReferenceSettings&) {};
    std::string plane_prefix = {};  // "half_a." to take that half
    bool in_shards = false;
};
inline Way by(EmitterSampling sampling) {
    static const char* const names[] = {"lights", "directions", "both"};
    return {names[static_cast<int>(sampling)],
            [=](ReferenceSettings& settings) { settings.emitter_sampling = sampling; }};
}
inline Way roulette_after(int bounces) {
    return {fmt::format("roulette after {}", bounces),
            [=](ReferenceSettings& settings) { settings.roulette_after = bounces; }};
}
inline const Way as_it_is{"as it is"}, half_a{"half A", {}, "half_a."}, half_b{"half B", {}, "half_b."},
    shards{"shards", {}, "", true},
    random_points{"random points", [](ReferenceSettings&settings) { settings.points = SamplePoints::random; }},
    antialiased{"antialiased", [](ReferenceSettings&settings) { settings.antialias = true; }};

// Both changes at once.
inline Way with(const Way& one, const Way& other) {
    return {fmt::format("{} with {}", one.name, other.name), [=](ReferenceSettings& settings) {
                one.change(settings);
                other.change(settings);
            }};
}

inline Frame render_in_shards(const PathTracer& tracer, const View& view, ReferenceSettings settings) {
    const auto folder = std::filesystem::temp_directory_path() / fmt::format("plumbline_proofs_{}", ::getpid());
    std::filesystem::create_directories(folder);
    const int samples = settings.samples, cut = samples / 4 * 2 + 2;
    settings.samples = cut;
    tracer.render_shard(view, settings, folder / "first");
    settings.first_sample = cut, settings.samples = samples;
    tracer.render_shard(view, settings, folder / "second");
    settings.first_sample = 0;
    Frame frame = tracer.merge(view, settings, {folder / "first", folder / "second"}).result().frame;
    std::filesystem::remove_all(folder);
    return frame;
}

struct Comparison {
    Setting setting;
    Way a, b;
    std::vector<std::string> planes;
    int bounces = 1;
    int samples = 2048;  // per pixel of each rendering, for the power to see 1 %
    int seeds = 12;
};

// By plane. The two ways have seeds of their own, so that nothing ties them together.
inline std::map<std::string, Replicates> replicates(const Comparison& comparison, const Way& way,
                                                    std::uint64_t first_seed) {
    std::map<std::string, Replicates> result;
    const PathTracer tracer(comparison.setting.scene);
    for (int i = 0; i < comparison.seeds; ++i) {
        auto settings = settings_for(comparison.planes, comparison.samples, comparison.bounces);
        settings.seed = first_seed + static_cast<std::uint64_t>(i);
        if (way.change) way.change(settings);
        const Frame frame = way.in_shards ? render_in_shards(tracer, comparison.setting.view, settings)
                                          : tracer.render(comparison.setting.view, settings).frame;
        for (const std::string& plane : comparison.planes) result[plane].add(frame.plane(way.plane_prefix + plane));
    }
    return result;
}

inline std::string name_of(const Comparison& comparison) {
    return fmt::format("{}: {} against {}", comparison.setting.name, comparison.a.name, comparison.b.name);
}

inline void expect_agreement(const Comparison& comparison) {
    const auto a = replicates(comparison, comparison.a, 1000), b = replicates(comparison, comparison.b, 2000);
    for (const std::string& plane : comparison.planes) {
        expect_agreement(a.at(plane), b.at(plane), fmt::format("{}, {}", name_of(comparison), plane));
    }
}

inline std::string test_name(const Comparison& comparison) {
    std::string name = name_of(comparison);
    std::erase(name, ':');
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
}

}  // namespace plumb

#include <functional>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "scenes/scene.h"

namespace plumb {
namespace {

Scene small_scene() {
    Scene scene;
    scene.meshes = {{"m",
                     {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                     {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
                     {{0, 0}, {1, 0}, {0, 1}},
                     {{0, 1, 2}},
                     0}};
    scene.instances = {{"i", 0, glm::mat4(1.0f)}};
    scene.materials = {Material{}, Material{}};
    Texture texture;
    texture.width = texture.height = 1;
    texture.texels = {half(1), half(1), half(1), half(1)};
    scene.textures = {texture};
    scene.point_lights = {PointLight{}};
    scene.spot_lights = {SpotLight{}};
    scene.directional_lights = {DirectionalLight{}};
    scene.cameras = {Camera{}};
    return scene;
}

TEST(ContentHash, ChangesWithEverythingThatCanChangeAPixel) {
    using Change = std::function<void(Scene&)>;
    const std::vector<std::pair<std::string, Change>> changes = {
        {"position", [](Scene& s) { s.meshes[0].positions[1].x = 2; }},
        {"normal",
         [](Scene& s) {
             s.meshes[0].normals[0] = {0, 1, 0};
         }},
        {"no normals", [](Scene& s) { s.meshes[0].normals.clear(); }},
        {"uv", [](Scene& s) { s.meshes[0].uvs[0].x = 0.5f; }},
        {"winding",
         [](Scene& s) {
             s.meshes[0].triangles[0] = {0, 2, 1};
         }},
        {"mesh material", [](Scene& s) { s.meshes[0].material = 1; }},
        {"instance", [](Scene& s) { s.instances.push_back(s.instances[0]); }},
        {"transform", [](Scene& s) { s.instances[0].world_from_object[3].x = 1; }},
        {"motion", [](Scene& s) { s.instances[0].motion.keys = {{}}; }},
        {"motion key time", [](Scene& s) { s.instances[0].motion.keys = {{.time = 1.0f}}; }},
        {"motion translation",
         [](Scene& s) {
             s.instances[0].motion.keys = {{.translation = {1, 0, 0}}};
         }},
        {"motion rotation",
         [](Scene& s) {
             s.instances[0].motion.keys = {{.rotation = {0, 1, 0, 0}}};
         }},
        {"motion scale",
         [](Scene& s) {
             s.instances[0].motion.keys = {{.scale = {1, 2, 1}}};
         }},
        {"motion interpolation",
         [](Scene& s) {
             s.instances[0].motion.keys = {{}};
             s.instances[0].motion.interpolation = MotionInterpolation::linear;
         }},
        {"motion pivot",
         [](Scene& s) {
             s.instances[0].motion.keys = {{}};
             s.instances[0].motion.pivot.x = 1;
         }},
        {"motion rest",
         [](Scene& s) {
             s.instances[0].motion.keys = {{}};
             s.instances[0].motion.rest[3].x = 1;
         }},
        {"base colour", [](Scene& s) { s.materials[0].base_colour.x = 0.1f; }},
        {"base colour texture", [](Scene& s) { s.materials[0].base_colour_texture = 0; }},
        {"metallic", [](Scene& s) { s.materials[0].metallic = 0.5f; }},
        {"roughness", [](Scene& s) { s.materials[0].roughness = 0.5f; }},
        {"metallic texture", [](Scene& s) { s.materials[0].metallic_roughness_texture = 0; }},
        {"dielectric reflectance", [](Scene& s) { s.materials[0].dielectric_reflectance = 0.04f; }},
        {"transmission", [](Scene& s) { s.materials[0].transmission.y = 0.5f; }},
        {"emission", [](Scene& s) { s.materials[0].emission.y = 1; }},
        {"emission texture", [](Scene& s) { s.materials[0].emission_texture = 0; }},
        {"alpha mask", [](Scene& s) { s.materials[0].alpha_mask = true; }},
        {"alpha cutoff", [](Scene& s) { s.materials[0].alpha_cutoff = 0.4f; }},
        {"alpha texture", [](Scene& s) { s.materials[0].alpha_texture = 0; }},
        {"alpha channel", [](Scene& s) { s.materials[0].alpha_channel = 0; }},
        {"two-sided", [](Scene& s) { s.materials[0].two_sided = false; }},
        {"texel", [](Scene& s) { s.textures[0].texels[2] = half(0.5f); }},
        {"wrap u", [](Scene& s) { s.textures[0].wrap_u = TextureWrap::clamp; }},
        {"wrap v", [](Scene& s) { s.textures[0].wrap_v = TextureWrap::mirror; }},
        {"point position", [](Scene& s) { s.point_lights[0].position.z = 1; }},
        {"point intensity", [](Scene& s) { s.point_lights[0].intensity.z = 2; }},
        {"point constant", [](Scene& s) { s.point_lights[0].attenuation.constant = 1; }},
        {"point linear", [](Scene& s) { s.point_lights[0].attenuation.linear = 1; }},
        {"point quadratic", [](Scene& s) { s.point_lights[0].attenuation.quadratic = 2; }},
        {"spot attenuation", [](Scene& s) { s.spot_lights[0].attenuation.linear = 1; }},
        {"spot position", [](Scene& s) { s.spot_lights[0].position.z = 1; }},
        {"spot direction",
         [](Scene& s) {
             s.spot_lights[0].direction = {1, 0, 0};
         }},
        {"spot intensity", [](Scene& s) { s.spot_lights[0].intensity.z = 2; }},
        {"spot inner", [](Scene& s) { s.spot_lights[0].inner_angle = 0.1f; }},
        {"spot outer", [](Scene& s) { s.spot_lights[0].outer_angle = 0.2f; }},
        {"sun direction",
         [](Scene& s) {
             s.directional_lights[0].direction = {1, 0, 0};
         }},
        {"sun irradiance", [](Scene& s) { s.directional_lights[0].irradiance.x = 3; }},
        {"sun disc", [](Scene& s) { s.directional_lights[0].angular_radius = 0.005f; }},
        {"sky", [](Scene& s) { s.environment.radiance.x = 1; }},
        {"sky image", [](Scene& s) { s.environment.texture = 0; }},
        {"sky rotation", [](Scene& s) { s.environment.rotation = 1; }},
    };
    std::set<std::uint64_t> hashes = {small_scene().content_hash()};
    for (const auto& [name, change] : changes) {
        Scene scene = small_scene();
        change(scene);
        EXPECT_TRUE(hashes.insert(scene.content_hash()).second) << name << " did not change the hash to a new one";
    }
}

TEST(ContentHash, IgnoresNamesViewsAndNotes) {
    Scene scene = small_scene();
    scene.name = scene.description = scene.meshes[0].name = scene.instances[0].name = scene.materials[0].name = "other";
    scene.textures[0].name = scene.point_lights[0].name = "other";
    scene.cameras.clear();
    scene.paths.push_back({});
    scene.import_notes.push_back("note");
    EXPECT_EQ(scene.content_hash(), small_scene().content_hash());
}

}  // namespace
}  // namespace plumb

#include "scenes/scene_file_tables.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/scene_error.h"
#include "scenes/toml_reader.h"

namespace plumb {
namespace {

glm::vec3 read_direction(TomlReader& reader, const char* key, const glm::vec3& otherwise) {
    glm::vec3 direction = otherwise;
    reader.read(key, direction);
    if (!(glm::length(direction) > 1e-6f)) reader.complain(key, fmt::format("has a '{}' of zero length", key));
    return glm::normalize(direction);
}

void read_attenuation(TomlReader& light, Attenuation& attenuation) {
    if (!light.has("attenuation")) return;
    TomlReader entry = light.table("attenuation");
    entry.require("constant", attenuation.constant);
    entry.require("linear", attenuation.linear);
    entry.require("quadratic", attenuation.quadratic);
    entry.finish();
}

template <typename Named>
void add_or_replace(std::vector<Named>& items, Named item) {
    std::erase_if(items, [&](const Named& other) { return other.name == item.name; });
    items.push_back(std::move(item));
}

// Seconds, translation and scale as they stand; the rotation from an axis and an angle in degrees.
MotionKey read_motion_key(TomlReader& reader, float& angle) {
    MotionKey key;
    reader.require("time", key.time);
    reader.read("translation", key.translation);
    reader.read("scale", key.scale);
    angle = 0.0f;
    if (reader.read("angle", angle)) {
        if (!reader.has("axis")) reader.complain("angle", "has an angle but no axis to turn about");
        key.rotation = glm::angleAxis(glm::radians(angle), read_direction(reader, "axis", {0.0f, 1.0f, 0.0f}));
    } else if (reader.has("axis")) {
        reader.complain("axis", "has an axis but no angle");
    }
    reader.finish();
    return key;
}

Motion read_keys(TomlReader& entry) {
    Motion motion;
    std::string interpolation = "smooth";
    entry.read("interpolation", interpolation);
    if (interpolation == "linear") {
        motion.interpolation = MotionInterpolation::linear;
    } else if (interpolation != "smooth") {
        entry.complain("interpolation",
                       fmt::format("has interpolation = '{}'; it must be 'smooth' or 'linear'", interpolation));
    }
    float angle = 0.0f, previous_angle = 0.0f;
    for (TomlReader& reader : entry.tables("keys")) {
        motion.keys.push_back(read_motion_key(reader, angle));
        // The quaternion of a whole turn more is another sign or the same again: the turn would be lost.
        if (motion.keys.size() > 1 && std::abs(angle - previous_angle) >= 358.0f) {
            reader.complain("angle", fmt::format("turns from {} to {} degrees at once; put another key between, less "
                                                 "than a whole turn from either",
                                                 previous_angle, angle));
        }
        previous_angle = angle;
    }
    if (motion.keys.empty()) entry.complain("keys", "has no keys");
    try {
        motion.check();
    } catch (const SceneError& error) {
        entry.complain("keys", fmt::format("is no motion: {}", error.what()));
    }
    return motion;
}

}  // namespace

void read_materials(TomlReader& scene_file, Scene& scene) {
    TomlReader reader = scene_file.table("materials");
    for (const std::string& name : reader.names()) {
        TomlReader entry = reader.table(name);
        bool found = false;
        for (Material& material : scene.materials) {
            if (material.name != name) continue;
            found = true;
            entry.read("base_colour", material.base_colour);
            entry.read("metallic", material.metallic);
            entry.read("roughness", material.roughness);
            entry.read("dielectric_reflectance", material.dielectric_reflectance);
            entry.read("transmission", material.transmission);
            entry.read("emission", material.emission);
            entry.read("two_sided", material.two_sided);
        }
        if (!found) {
            std::vector<std::string> names;
            for (const Material& material : scene.materials) names.push_back(material.name);
            reader.complain(name, fmt::format("names a material '{}' that the mesh file does not have; it has: {}",
                                              name, fmt::join(names, ", ")));
        }
        entry.finish();
    }
}

void read_lights(TomlReader& reader, Scene& scene) {
    for (TomlReader& entry : reader.tables("point_lights")) {
        PointLight light;
        entry.read("name", light.name);
        entry.require("position", light.position);
        entry.require("intensity", light.intensity);
        read_attenuation(entry, light.attenuation);
        entry.finish();
        scene.point_lights.push_back(light);
    }
    for (TomlReader& entry : reader.tables("spot_lights")) {
        SpotLight light;
        entry.read("name", light.name);
        entry.require("position", light.position);
        entry.require("intensity", light.intensity);
        glm::vec3 target;
        if (entry.read("target", target)) {
            if (entry.has("direction")) entry.complain("direction", "has both a direction and a target; give one");
            if (target == light.position) entry.complain("target", "has its target where it stands; move one of them");
            light.direction = glm::normalize(target - light.position);
        } else {
            light.direction = read_direction(entry, "direction", light.direction);
        }
        float inner = glm::degrees(light.inner_angle), outer = glm::degrees(light.outer_angle);
        entry.read("inner_angle", inner);
        entry.read("outer_angle", outer);
        light.inner_angle = glm::radians(inner);
        light.outer_angle = glm::radians(outer);
        read_attenuation(entry, light.attenuation);
        entry.finish();
        scene.spot_lights.push_back(light);
    }
    for (TomlReader& entry : reader.tables("directional_lights")) {
        DirectionalLight light;
        entry.read("name", light.name);
        light.direction = read_direction(entry, "direction", light.direction);
        entry.require("irradiance", light.irradiance);
        float radius = 0.0f;
        if (entry.read("angular_radius", radius)) light.angular_radius = glm::radians(radius);
        entry.finish();
        scene.directional_lights.push_back(light);
    }
}

void read_views(TomlReader& reader, Scene& scene) {
    for (TomlReader& entry : reader.tables("views")) {
        std::string name;
        glm::vec3 eye, target, up(0.0f, 1.0f, 0.0f);
        float fov = 50.0f;
        entry.require("name", name);
        entry.require("eye", eye);
        entry.require("target", target);
        entry.read("up", up);
        entry.read("vertical_fov", fov);
        Camera camera = Camera::look_at(name, eye, target, glm::radians(fov), up);
        entry.read("near", camera.near_plane);
        entry.read("far", camera.far_plane);
        camera.focus_distance = glm::distance(eye, target);
        entry.read("aperture_radius", camera.aperture_radius);
        entry.read("focus_distance", camera.focus_distance);
        entry.finish();
        (void)View(camera, 1, 1);  // complains about planes and angles now rather than when it is used
        add_or_replace(scene.cameras, std::move(camera));
    }
}

void read_paths(TomlReader& reader, Scene& scene) {
    for (TomlReader& entry : reader.tables("paths")) {
        CameraPath path;
        float fov = glm::degrees(path.vertical_fov);
        entry.require("name", path.name);
        entry.read("vertical_fov", fov);
        entry.read("near", path.near_plane);
        entry.read("far", path.far_plane);
        entry.read("aperture_radius", path.aperture_radius);
        entry.read("focus_distance", path.focus_distance);
        path.vertical_fov = glm::radians(fov);
        for (TomlReader& key : entry.tables("keys")) {
            CameraKey camera_key;
            key.require("time", camera_key.time);
            key.require("eye", camera_key.eye);
            key.require("target", camera_key.target);
            key.finish();
            path.keys.push_back(camera_key);
        }
        entry.finish();
        (void)View(path.at(0.0f), 1, 1);  // complains about keys, planes and angles now
        add_or_replace(scene.paths, std::move(path));
    }
}

void read_motions(TomlReader& reader, Scene& scene) {
    for (TomlReader& entry : reader.tables("motions")) {
        std::string name;
        entry.require("instance", name);
        Motion motion = read_keys(entry);
        std::vector<Instance*> moved;
        std::set<std::string> names;
        Bounds bounds;
        for (Instance& instance : scene.instances) {
            names.insert(instance.name);
            if (instance.name != name) continue;
            moved.push_back(&instance);
            bounds.add(scene.bounds(instance));
        }
        if (moved.empty()) {
            entry.complain("instance", fmt::format("names an instance '{}' that the scene does not have; it has: {}",
                                                   name, fmt::join(names, ", ")));
        }
        if (moved.front()->moves()) entry.complain("instance", fmt::format("moves '{}' once more", name));
        motion.pivot = bounds.centre();
        entry.read("pivot", motion.pivot);
        entry.finish();
        for (Instance* instance : moved) {
            instance->motion = motion;
            instance->motion.rest = instance->world_from_object;
        }
    }
    scene.move_to(0.0);
}

std::vector<std::string> moving_instances(TomlReader& scene_file) {
    std::vector<std::string> names;
    for (TomlReader& entry : scene_file.tables("motions")) {
        if (std::string name; entry.read("instance", name)) names.push_back(name);
    }
    return names;
}

}  // namespace plumb

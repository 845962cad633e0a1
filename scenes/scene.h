// A scene: the one description of what there is to see. No renderer reads a file or owns a material model of its own.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/camera.h"
#include "scenes/camera_path.h"
#include "scenes/light.h"
#include "scenes/material.h"
#include "scenes/motion.h"
#include "scenes/surface_sample.h"
#include "scenes/texture.h"

namespace plumb {

// Indexed triangles of one material.
struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;     // empty: face normals; else unit length, one per position
    std::vector<glm::vec2> uvs;         // empty: (0, 0); else one per position
    std::vector<glm::uvec3> triangles;  // counter-clockwise seen from the side that the normals point to
    int material = 0;                   // index into Scene::materials
};

struct Instance {
    std::string name;
    int mesh = 0;                       // index into Scene::meshes
    glm::mat4 world_from_object{1.0f};  // at the scene's present time
    Motion motion{};                    // without keys: the instance stands still

    bool moves() const { return !motion.keys.empty(); }
    // world_from_object at `time` (seconds); always the same for an instance that stands still.
    glm::mat4 pose(double time) const { return moves() ? motion.pose(time) : world_from_object; }
};

struct Bounds {
    glm::vec3 lower{1e30f}, upper{-1e30f};
    void add(const glm::vec3& point) { lower = glm::min(lower, point), upper = glm::max(upper, point); }
    void add(const Bounds& other) { lower = glm::min(lower, other.lower), upper = glm::max(upper, other.upper); }
    bool empty() const { return lower.x > upper.x; }
    glm::vec3 centre() const { return 0.5f * (lower + upper); }
    float diagonal() const { return empty() ? 0.0f : glm::length(upper - lower); }
};

struct Scene {
    std::string name;
    std::string description;
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<PointLight> point_lights;
    std::vector<SpotLight> spot_lights;
    std::vector<DirectionalLight> directional_lights;
    Environment environment;
    std::vector<Camera> cameras;
    std::vector<CameraPath> paths;
    std::vector<std::string> import_notes;  // what was repaired, dropped or replaced on the way in

    // Throw SceneError that lists the names there are.
    const Camera& camera(std::string_view camera_name) const;
    const CameraPath& path(std::string_view path_name) const;

    std::size_t triangle_count() const;  // over all instances
    Bounds bounds() const;               // world space, over all instances as they stand now
    Bounds bounds(const Instance& instance) const;
    bool has_emissive_surfaces() const;

    // Moves every instance that moves to where it is at `time` (seconds).
    void move_to(double time);

    // Material `material` at `uv`.
    SurfaceSample surface(const Material& material, glm::vec2 uv) const;
    // False in an alpha-masked hole.
    bool is_opaque(const Material& material, glm::vec2 uv) const;
    // Radiance of the environment from unit `direction`.
    glm::vec3 environment_radiance(const glm::vec3& direction) const;

    // No channel of the radiance that surfaces emit, or that the environment sends, is above it.
    float brightest_emission() const;

    // A 64-bit hash of everything that can change a pixel: geometry and its motion, materials, texels, lights; not
    // cameras, paths, names.
    std::uint64_t content_hash() const;
};

}  // namespace plumb

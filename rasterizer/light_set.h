// All lights of a scene as the deferred pass wants them, and the shadow maps that they need.
#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "rasterizer/emitter_light.h"
#include "rasterizer/method.h"
#include "scenes/scene.h"

namespace plumb {

// Six square views around a point; depth is near / (distance along the face's axis).
struct ShadowCube {
    glm::vec3 position{0.0f};
    float near_plane = 0.01f;
    int ignored_instance = -1;                      // does not cast into this map
    glm::vec4 front_plane{0.0f, 0.0f, 0.0f, 1.0f};  // nor does what lies behind it
};

// One view; depth 1 nearest to the light, 0 farthest.
struct ShadowMap {
    glm::mat4 clip_from_world{1.0f};
};

// std430 layouts of direct_light.frag. `cube` and `map` are layers of the shadow textures.
struct PointRecord {
    glm::vec3 position;
    float near_plane;
    glm::vec3 intensity;
    int cube;
    glm::vec4 attenuation;  // constant, linear, quadratic
};
struct SpotRecord {
    glm::vec3 position;
    int map;  // -1: wider than a flat map can be, `cube` holds it
    glm::vec3 direction;
    float cosine_outer;
    glm::vec3 intensity;
    float cosine_inner;
    glm::mat4 clip_from_world;
    float texel_size;  // at 1 m
    float near_plane;
    int cube;
    float padding;
    glm::vec4 attenuation;
};
struct DirectionalRecord {
    glm::vec3 direction;
    int map;
    glm::vec3 irradiance;
    float texel_size;  // metres
    glm::mat4 clip_from_world;
    glm::vec4 right, up;  // axes of the map
};
struct EmitterRecord {
    int first_piece, pieces;
    int first_cube, cubes;
    int discs, both_sides;
    int padding[2];
};
struct EmitterCubeRecord {
    glm::vec3 position;
    float near_plane;
};

struct LightSet {
    LightSet(const Scene& scene, const ShadowSettings& settings);

    std::vector<PointRecord> points;
    std::vector<SpotRecord> spots;
    std::vector<DirectionalRecord> directionals;
    std::vector<EmitterRecord> emitters;
    std::vector<EmitterPiece> pieces;
    std::vector<EmitterCubeRecord> emitter_cube_records;

    std::vector<ShadowCube> point_cubes, emitter_cubes;
    std::vector<ShadowMap> maps;

    bool empty() const { return points.empty() && spots.empty() && directionals.empty() && emitters.empty(); }
    // "2 point lights, 1 emissive surface"
    std::string summary() const;
};

}  // namespace plumb

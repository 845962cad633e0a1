// All lights of a scene as the deferred pass wants them, and the shadow maps that they need.
#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "rasterizer/emitter_light.h"
#include "rasterizer/method.h"
#include "scenes/scene.h"

namespace plumb {

// All that is seen from a point, in a cube or two paraboloids.
struct ShadowCube {
    glm::vec3 position{0.0f};
    float near_plane = 0.01f;
    float range = 1.0f;                             // metres: no surface lies farther away
    int ignored_instance = -1;                      // does not cast into this map
    glm::vec4 front_plane{0.0f, 0.0f, 0.0f, 1.0f};  // nor does what lies behind it
};

// One view; depth 1 nearest to the light, 0 farthest.
struct ShadowMap {
    glm::mat4 clip_from_world{1.0f};
};

// std430 layouts of local_light.glsl and direct_light.frag. `cube` and `map` count within the shadow textures (`cube`
// in shadow.points or shadow.paraboloids); -1: none. `depth_scale` is what a depth of the cube is a ratio to: the near
// plane, or the range where distances are linear.
struct PointRecord {
    glm::vec3 position;
    float depth_scale;
    glm::vec3 intensity;
    int cube;
    glm::vec4 attenuation;  // constant, linear, quadratic
};
struct SpotRecord {
    glm::vec3 position;
    int map;  // a cone wider than a flat map can be has a `cube` instead
    glm::vec3 direction;
    float cosine_outer;
    glm::vec3 intensity;
    float cosine_inner;
    glm::mat4 clip_from_world;
    float texel_size;  // at 1 m
    float depth_scale;
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
    float depth_scale;
};

// Of what a pass computes the light.
enum class LightKinds { all, lamps };  // lamps: all but emissive surfaces

struct LightSet {
    // Emissive surfaces are left out where `direct` does not want them.
    LightSet(const Scene& scene, const DirectSettings& direct);

    std::vector<PointRecord> points;
    std::vector<SpotRecord> spots;
    std::vector<DirectionalRecord> directionals;
    std::vector<EmitterRecord> emitters;
    std::vector<EmitterPiece> pieces;
    std::vector<EmitterCubeRecord> emitter_cube_records;

    std::vector<ShadowCube> point_cubes, point_paraboloids, emitter_cubes;
    std::vector<ShadowMap> maps;

    bool empty() const { return points.empty() && spots.empty() && directionals.empty() && emitters.empty(); }
    bool any_shadows() const {
        return !(point_cubes.empty() && point_paraboloids.empty() && emitter_cubes.empty() && maps.empty());
    }
    // "2 point lights, 1 emissive surface"
    std::string summary() const;
};

}  // namespace plumb

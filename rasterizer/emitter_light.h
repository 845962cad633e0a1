// Emissive surfaces as lights of the deferred pass.
//
// Each instance of an emissive material is one emitter, made of pieces. Up to 64 triangles are kept as they are and lit
// analytically (polygon_light.glsl: exact without occlusion). A finer mesh is gathered into 64 clusters of equal power,
// of triangles that face alike and lie together; each shines like a small disc of their area and mean direction: good
// from farther away than a cluster is wide, too smooth close by.
// The mean of an emission texture over a triangle stands for its texels.
//
// Emitters stand where the scene has them; moving_emitters.h takes those along that move.
//
// Visibility is that of a few points of the emitter, whose mean over cube shadow maps multiplies all pieces.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace plumb {

// std430 layout of direct_light.frag. A triangle's corners; or a disc's centre and vector area (towards its front).
struct EmitterPiece {
    glm::vec3 a;
    float red;  // radiance
    glm::vec3 b;
    float green;
    glm::vec3 c;
    float blue;
};

struct EmitterLight {
    int instance = 0;
    bool both_sides = false;  // shines from its back as well; never for a closed surface, whose back nobody sees
    bool discs = false;       // pieces are discs, else triangles
    std::vector<EmitterPiece> pieces;
    std::vector<glm::vec3> sample_points;  // where visibility is tested
    // Flat and one-sided: what lies behind this plane (dot(plane, (p, 1)) < 0) cannot stand in the light. Else (0, 0,
    // 0, 1).
    glm::vec4 front_plane{0.0f, 0.0f, 0.0f, 1.0f};
};

constexpr int most_emitter_pieces = 64;

// All emitters of the scene, in the order of instances; emissive surfaces without area or radiance are left out.
std::vector<EmitterLight> find_emitters(const Scene& scene, int sample_points);

}  // namespace plumb

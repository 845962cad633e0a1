// Rays of many paths and what they meet.
#pragma once

#include <array>

#include "pathtracer/lanes.h"
#include "pathtracer/surface_hit.h"

namespace plumb {

// The time at which geometry stands where nothing is said of a shutter: the end of the scene's time span.
constexpr float now = 1.0f;

// `count` rays; distances are in units of the direction's length.
struct RayBatch {
    int count = 0;
    VectorLanes origin, direction;
    Lanes<float> nearest, farthest;
    Lanes<float> time;  // 0..1 over the scene's time span

    void add(const glm::vec3& from, const glm::vec3& towards, float reach, float when) {
        origin.set(count, from), direction.set(count, towards);
        nearest[count] = positive_distance, farthest[count] = reach, time[count] = when;
        ++count;
    }
};

using HitBatch = std::array<SurfaceHit, most_lanes>;

// The geometry of the points that rays met, and their diffuse and emitted light.
struct SurfaceLanes {
    VectorLanes ray_origin, geometric_normal, shading_normal, albedo, emission;
};

}  // namespace plumb

// Rays of many paths and what they meet.
#pragma once

#include <cstdint>

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

    PLUMBLINE_INLINE void set(int lane, const glm::vec3& from, const glm::vec3& towards, float reach, float when) {
        direction.set(lane, towards);
        set_origin(lane, from, reach, when);
    }
    // All but the direction, which stands there already.
    PLUMBLINE_INLINE void set_origin(int lane, const glm::vec3& from, float reach, float when) {
        origin.set(lane, from);
        nearest[lane] = positive_distance, farthest[lane] = reach, time[lane] = when;
    }
    void add(const glm::vec3& from, const glm::vec3& towards, float reach, float when) {
        set(count++, from, towards, reach, when);
    }
};

// What the rays of a batch met; as SurfaceHit says.
struct HitBatch {
    Lanes<std::uint32_t> instance, triangle;
    Lanes<float> u, v, distance;

    PLUMBLINE_INLINE bool missed(int lane) const { return instance[lane] == SurfaceHit::nothing; }
    SurfaceHit get(int lane) const {
        if (missed(lane)) return {};
        return {instance[lane], triangle[lane], u[lane], v[lane], distance[lane]};
    }
    void set(int lane, const SurfaceHit& hit) {
        instance[lane] = hit.instance, triangle[lane] = hit.triangle;
        u[lane] = hit.u, v[lane] = hit.v, distance[lane] = hit.distance;
    }
};

// The geometry of points that rays met, and their diffuse and emitted light; as SurfacePoint says.
struct SurfaceLanes {
    VectorLanes ray_origin, geometric_normal, shading_normal, albedo, emission;
    Lanes<float> bulge;

    // Of a ray that starts that far above the surface.
    PLUMBLINE_INLINE glm::vec3 origin(int lane, float rise) const {
        return ray_origin.get(lane) + rise * shading_normal.get(lane);
    }
};

// The rays of a batch that met something, in their order.
struct MetRays {
    int count = 0;
    Lanes<int> ray;

    void find(const RayBatch& rays, const HitBatch& hits) {
        count = 0;
        for (int i = 0; i < rays.count; ++i) {
            ray[count] = i;
            count += hits.missed(i) ? 0 : 1;
        }
        complete_group();
    }
    // Repeats the last one to the end of its group: what loops over whole groups look up is there.
    void complete_group() {
        for (int i = count; i < whole_groups(count); ++i) ray[i] = ray[count - 1];
    }
};

}  // namespace plumb

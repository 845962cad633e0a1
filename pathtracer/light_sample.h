// A light as next-event estimation sampled it for a receiver, and such samples side by side.
#pragma once

#include <glm/glm.hpp>

#include "pathtracer/ray_batch.h"

namespace plumb {

// Where light arrives. What lies below the face but not below the horizon of the normal is seen from `bulge` above the
// origin (SurfacePoint).
struct LightReceiver {
    glm::vec3 origin;       // of rays
    glm::vec3 normal;       // of shading
    glm::vec3 lobe_normal;  // about which a specular lobe stands (scenes/ggx.h); where there is none: `normal`
    glm::vec3 geometric_normal;
    float bulge = 0.0f;
    float time = now;

    LightReceiver bulging() const {
        return {origin + bulge * normal, normal, lobe_normal, geometric_normal, 0.0f, time};
    }
    bool sees_from_bulge(const glm::vec3& direction) const {
        return bulge > 0.0f && glm::dot(geometric_normal, direction) <= 0.0f;
    }
};

struct LightSample {
    glm::vec3 direction{0.0f};  // unit, towards the light
    // What has to be clear for the light to arrive: from `rise` above the receiver along `shadow_ray`, up to `farthest`
    // times it.
    glm::vec3 shadow_ray{0.0f};
    float rise = 0.0f;  // the receiver's bulge, or 0
    float farthest = infinite_distance;
    glm::vec3 radiance{0.0f};  // already divided by the density; times cosine and BSDF it is the estimate. 0: no light
    float density = 0.0f;      // per solid angle, with the choice of the light; 0: nothing but this sampling finds it
};

// Samples of many paths.
struct LightLanes {
    VectorLanes direction, shadow_ray, radiance;
    Lanes<float> rise, farthest, density;

    PLUMBLINE_INLINE void set(int lane, const LightSample& sample) {
        direction.set(lane, sample.direction), shadow_ray.set(lane, sample.shadow_ray);
        radiance.set(lane, sample.radiance);
        rise[lane] = sample.rise, farthest[lane] = sample.farthest, density[lane] = sample.density;
    }
};

}  // namespace plumb

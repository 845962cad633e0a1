// A light as next-event estimation sampled it for a receiver, and such samples
// side by side.
#pragma once

#include <glm/glm.hpp>

#include "pathtracer/ray_batch.h"

namespace plumb {

// Where light arrives.
struct LightReceiver {
    glm::vec3 origin;  // of rays
    glm::vec3 normal;  // of shading
    float time = now;
};

struct LightSample {
    glm::vec3 direction{0.0f};  // unit, towards the light
    // What has to be clear for the light to arrive: from the receiver along
    // `shadow_ray`, up to `farthest` times it.
    glm::vec3 shadow_ray{0.0f};
    float farthest = infinite_distance;
    glm::vec3 radiance{0.0f};  // already divided by the density; times cosine and
                               // BSDF it is the estimate. 0: no light
    float density = 0.0f;      // per solid angle, with the choice of the light; 0:
                               // nothing but this sampling finds it
};

// Samples of many paths.
struct LightLanes {
    VectorLanes direction, shadow_ray, radiance;
    Lanes<float> farthest, density;

    void set(int lane, const LightSample& sample) {
        direction.set(lane, sample.direction), shadow_ray.set(lane, sample.shadow_ray);
        radiance.set(lane, sample.radiance);
        farthest[lane] = sample.farthest, density[lane] = sample.density;
    }
};

}  // namespace plumb

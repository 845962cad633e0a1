// All lights of a scene, as next-event estimation samples them.
//
// Lights with an extent (emissive surfaces, image environments) may also be found by rays, so their samples carry a
// density per solid angle for multiple importance sampling. One of them is chosen by power, image and surfaces half and
// half. Lights without extent (point, spot, directional) are told apart: their unshadowed contribution at a point is
// known, and one is chosen in proportion to it, so that a lamp in a dark corner is not lost beside the sun.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "pathtracer/discrete_distribution.h"
#include "pathtracer/environment_distribution.h"
#include "pathtracer/reference.h"
#include "pathtracer/traced_scene.h"

namespace plumb {

struct LightSample {
    glm::vec3 direction{0.0f};  // unit, towards the light
    glm::vec3 end{0.0f};        // where the shadow ray ends; no meaning for lights infinitely far away
    bool infinitely_far = false;
    glm::vec3 radiance{0.0f};  // already divided by the density; times cosine and BSDF it is the estimate. 0: no light
    float density = 0.0f;      // per solid angle, with the choice of the light; 0: nothing but this sampling finds it
};

class LightTable {
public:
    LightTable(const TracedScene& scene, const EnvironmentDistribution& environment, EmitterSampling strategy);

    bool has_extended_lights() const {
        return !extended_.empty();
    }  // to be sampled: none for EmitterSampling::directions
    // Where true, cosine-distributed rays have to be followed to emitters (and to the environment).
    bool rays_find_emitters() const { return rays_find_triangles_ || rays_find_environment_; }
    bool rays_find_triangles() const { return rays_find_triangles_; }

    // Of all lights with an extent; `normal` is the receiving surface's.
    LightSample sample_extended(const glm::vec3& receiver, const glm::vec3& normal, float pick, glm::vec2 u) const;

    // Radiance of the emitter at `hit`, or of the environment, weighted against sample_extended, for a ray that was
    // drawn with density cosine / pi.
    glm::vec3 weighted_emission(const SurfaceHit& hit, const SurfacePoint& point, const glm::vec3& direction,
                                float cosine) const;
    glm::vec3 weighted_environment(const glm::vec3& direction, float cosine) const;

    // Lights without extent, one by one, for exact sums; and one of them for the sum.
    std::size_t lights_without_extent() const { return lights_without_extent_; }
    LightSample light_without_extent(std::size_t index, const glm::vec3& receiver) const;
    LightSample sample_without_extent(const glm::vec3& receiver, const glm::vec3& normal, float pick) const;

private:
    struct Emitter {
        TracedTriangle corners;
        glm::vec3 normal, error;
        float area;
        std::uint32_t instance;
    };

    void find_emitters(std::vector<double>& powers);
    LightSample sample_emitter(const Emitter& emitter, double probability, const glm::vec3& receiver,
                               glm::vec2 u) const;
    LightSample sample_environment(double probability, const glm::vec3& normal, glm::vec2 u) const;

    const TracedScene& scene_;
    const EnvironmentDistribution& environment_;
    EmitterSampling strategy_;
    std::vector<Emitter> emitters_;
    std::vector<std::uint32_t> first_emitter_;  // per instance; emitters of one instance lie one after the other
    std::size_t environment_index_ = 0;         // in extended_: after the emitters
    std::size_t lights_without_extent_ = 0;
    DiscreteDistribution extended_;
    bool rays_find_triangles_ = false, rays_find_environment_ = false;
};

}  // namespace plumb

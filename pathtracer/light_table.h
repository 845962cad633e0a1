// All lights of a scene, as next-event estimation chooses among them.
//
// One light is chosen with probability proportional to its power. Emissive surfaces and image environments have an
// extent: rays may find them too, so their samples carry a density per solid angle for multiple importance sampling.
// Point, spot and directional lights have none.
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
    // Which lights are chosen among: `extended` leaves out those without extent.
    enum class Choice { all, extended };

    LightTable(const TracedScene& scene, const EnvironmentDistribution& environment, EmitterSampling strategy);

    bool empty(Choice choice) const { return distribution(choice).empty(); }
    // Where true, cosine-distributed rays have to be followed to emitters (and to the environment).
    bool rays_find_emitters() const { return rays_find_triangles_ || rays_find_environment_; }
    bool rays_find_triangles() const { return rays_find_triangles_; }

    // `normal` is that of the receiving surface.
    LightSample sample(Choice choice, const glm::vec3& receiver, const glm::vec3& normal, float pick,
                       glm::vec2 u) const;

    // Radiance of the emitter at `hit`, or of the environment, weighted against sample(choice, ...), for a ray that was
    // drawn with density cosine / pi.
    glm::vec3 weighted_emission(Choice choice, const SurfaceHit& hit, const SurfacePoint& point,
                                const glm::vec3& direction, float cosine) const;
    glm::vec3 weighted_environment(Choice choice, const glm::vec3& direction, float cosine) const;

    // Lights without extent, one by one: for exact sums.
    std::size_t lights_without_extent() const;
    LightSample light_without_extent(std::size_t index, const glm::vec3& receiver) const;

private:
    struct Emitter {
        std::uint32_t instance, triangle;
        float area;
    };

    const DiscreteDistribution& distribution(Choice choice) const { return choice == Choice::all ? all_ : extended_; }
    void find_emitters(std::vector<double>& powers);
    LightSample sample_emitter(const Emitter& emitter, double probability, const glm::vec3& receiver,
                               glm::vec2 u) const;
    LightSample sample_environment(double probability, const glm::vec3& normal, glm::vec2 u) const;

    const TracedScene& scene_;
    const EnvironmentDistribution& environment_;
    EmitterSampling strategy_;
    std::vector<Emitter> emitters_;
    std::vector<std::uint32_t> first_emitter_;  // per instance; emitters of one instance lie one after the other
    std::size_t environment_index_ = 0;         // after the emitters; then come the lights without extent
    DiscreteDistribution all_, extended_;
    bool rays_find_triangles_ = false, rays_find_environment_ = false;
};

}  // namespace plumb

// All lights of a scene, as next-event estimation samples them.
//
// Lights with an extent (emissive surfaces, suns, environments) may also be found by rays, so their samples carry a
// density per solid angle for multiple importance sampling. One of them is chosen by power; where there is an
// environment image it and all the others get half of the samples each. (By the power that it sends through the scene's
// bounding sphere it would get nearly all of them, also where it is hidden: with that, at 256 samples, the error of
// indirect light in a closed room rose from 3.8 to 15.5 % and beside a lamp in the open from 5.8 to 12.7 %; only where
// the lamp gave next to nothing it fell, from 6.9 to 5.9 %.) Lights without extent (point, spot, parallel)
// are told apart: their unshadowed contribution at a point is known, and one is chosen in proportion to it, so that a
// lamp in a dark corner is not lost beside the sun.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "pathtracer/discrete_distribution.h"
#include "pathtracer/environment_distribution.h"
#include "pathtracer/light_sample.h"
#include "pathtracer/path_batch.h"
#include "pathtracer/reference.h"
#include "pathtracer/traced_scene.h"

namespace plumb {

class LightTable {
public:
    LightTable(const TracedScene& scene, const EnvironmentDistribution& environment, EmitterSampling strategy);

    // To be sampled: none for EmitterSampling::directions.
    bool has_extended_lights() const { return !extended_.empty(); }
    // Where true, sampled directions have to be followed to emitters (and beyond all surfaces).
    bool rays_find_emitters() const { return rays_find_triangles_ || rays_find_background_; }
    bool rays_find_triangles() const { return rays_find_triangles_; }
    bool has_background() const { return !suns_.empty() || !scene_.scene().environment.is_black(); }

    // Of all lights with an extent, at a point of the unit square. The first number chooses the light and, by where it
    // fell in that light's share, is the first of two that choose the point on it: well spread points of the square
    // stay well spread over all lights. In double, since a small share leaves few of a float's digits.
    LightSample sample_extended(const LightReceiver& receiver, double x, float y) const;
    // The same for each vertex; `x` in units of 2^-32.
    void sample_extended(const VertexBatch& receivers, const Lanes<std::uint32_t>& x, const Lanes<float>& y,
                         LightLanes& samples) const;

    // The weight against sample_extended of `emission` found at `hit`, on a surface with that geometric normal, by a
    // ray in unit `direction` that was drawn with `density`; 0 as density means that nothing else could have drawn it.
    float emission_weight(const SurfaceHit& hit, const glm::vec3& geometric_normal, const glm::vec3& direction,
                          float density, float time) const;
    // Radiance of environment and suns, weighted in the same way.
    glm::vec3 weighted_background(const glm::vec3& direction, float density) const;

    // Lights without extent, one by one, for exact sums; and one of them for the sum.
    std::size_t lights_without_extent() const { return lights_without_extent_; }
    LightSample light_without_extent(std::size_t index, const LightReceiver& receiver) const;
    LightSample sample_without_extent(const LightReceiver& receiver, float pick) const;
    // The same for each vertex.
    void sample_without_extent(const VertexBatch& receivers, const Lanes<float>& pick, LightLanes& samples) const;

private:
    // What sampling a triangle needs, side by side.
    struct Emitter {
        TracedTriangle corners;
        glm::vec3 normal;
        glm::vec3 emission;  // where it is the same everywhere
        float area, error;   // error: extent along the normal of the corners' rounding errors
        float probability = 0.0f, area_over_probability = 0.0f;
        std::uint32_t instance, triangle;
        bool two_sided, varies, moves;
    };
    // The emitters that lanes chose, as far as plain ones differ.
    struct EmitterLanes {
        VectorLanes a, b, c, normal, emission;
        Lanes<float> area_over_probability, error, back_emits;

        void set(int lane, const Emitter& emitter) {
            a.set(lane, emitter.corners.a), b.set(lane, emitter.corners.b), c.set(lane, emitter.corners.c);
            normal.set(lane, emitter.normal), emission.set(lane, emitter.emission);
            area_over_probability[lane] = emitter.area_over_probability, error[lane] = emitter.error;
            back_emits[lane] = emitter.two_sided ? 1.0f : 0.0f;
        }
    };
    struct Sun {
        glm::vec3 axis, radiance;  // axis: towards the light
        float height, density, probability = 0.0f;
    };

    // A point or spot light.
    struct LocalLight {
        glm::vec3 position, axis;  // axis: the way light travels; of a point light 0
        glm::vec3 intensity;
        Attenuation attenuation;
        float outer_cosine, inner_cosine;
    };

    void find_emitters(std::vector<double>& powers);
    void find_suns(std::vector<double>& powers);
    Emitter moved(const Emitter& emitter, float time) const;
    void look_up(const Lanes<std::uint32_t>& chosen, int count, EmitterLanes& lanes) const;
    // Of all that the receiver's origin sees, its face apart.
    LightSample sample_extended_from_origin(const LightReceiver& receiver, double x, float y) const;
    static LightSample from_local_light(const LocalLight& light, const glm::vec3& receiver);
    LightSample light_without_extent_from(const glm::vec3& origin, std::size_t index) const;
    LightSample sample_emitter(const Emitter& emitter, const LightReceiver& receiver, glm::vec2 u) const;
    LightSample sample_sun(const Sun& sun, glm::vec2 u) const;
    LightSample sample_environment(const LightReceiver& receiver, glm::vec2 u) const;

    const TracedScene& scene_;
    const EnvironmentDistribution& environment_;
    EmitterSampling strategy_;
    std::vector<Emitter> emitters_;
    std::vector<std::uint32_t> first_emitter_;  // per instance; emitters of one instance lie one after the other
    std::vector<Sun> suns_;
    std::vector<LocalLight> local_;      // point lights, then spot lights
    std::vector<std::size_t> parallel_;  // directional lights without an angular size
    std::size_t lights_without_extent_ = 0;
    float environment_probability_ = 0.0f;
    DiscreteDistribution extended_;     // emitters, suns, environment
    bool only_plain_emitters_ = false;  // nothing but triangles of one radiance each that stand still
    bool rays_find_triangles_ = false, rays_find_background_ = false;
};

}  // namespace plumb

// One sample of every stochastic quantity at one surface point.
//
// Follows one path of cosine-distributed directions from x. At each vertex k = 0..K it gathers the radiance that left a
// light and reached the vertex in one segment, by next-event estimation and, where emitters can be met, by the path's
// own next ray. What vertex k gathers, carried back to x, is `direct` for k = 0 and `indirect.k` for k > 0. The first
// ray also serves the ambient visibility.
//   Good for: all planes in one go. Nothing is traced that no wanted plane needs.
#pragma once

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

#include "frames/quantities.h"
#include "pathtracer/light_table.h"
#include "pathtracer/sample_sequence.h"
#include "pathtracer/traced_scene.h"

namespace plumb {

constexpr int most_bounces = 64;

// What has to be estimated; follows from the planes that are wanted.
struct EstimationPlan {
    bool ao = false, direct = false, indirect = false, irradiance = false;
    int bounces = 0;  // 0 where no indirect light is wanted
    float ao_radius = 1.0f;
    Falloff ao_falloff = Falloff::quadratic;
    float indirect_radius = infinite_distance;
    // Lights without extent reach x without randomness through pixel centres; they are added exactly, once per pixel.
    bool exact_lights_at_first_point = true;

    bool traces_anything() const { return ao || direct || indirect; }
};

struct PathEstimate {
    float ambient_visibility = 1.0f;
    std::array<glm::vec3, most_bounces + 1> radiance;  // by vertex; x's albedo / pi included as if x's albedo were 1
};

class PathIntegrator {
public:
    PathIntegrator(const TracedScene& scene, const LightTable& lights, const EstimationPlan& plan)
        : scene_(scene), lights_(lights), plan_(plan) {}

    // Entries 0..bounces of estimate.radiance are set. Returns how many rays were traced.
    int estimate(const SurfacePoint& x, const SampleSequence& sequence, PathEstimate& estimate) const;

    // The part of `direct` that lights without extent give, with x's albedo; deterministic. Counts rays into `rays`.
    glm::vec3 exact_direct(const SurfacePoint& x, std::uint64_t& rays) const;

    // The dimension of SampleSequence that spreads primary rays over the pixel.
    static constexpr std::uint32_t pixel_dimension = 0;

private:
    glm::vec3 next_event(const SurfacePoint& point, int vertex, const SampleSequence& sequence, int& rays) const;
    glm::vec3 reflected(const SurfacePoint& point, const LightSample& light, int& rays) const;
    float obscurance(float distance) const { return evaluate_falloff(plan_.ao_falloff, distance, plan_.ao_radius); }

    const TracedScene& scene_;
    const LightTable& lights_;
    EstimationPlan plan_;
};

}  // namespace plumb

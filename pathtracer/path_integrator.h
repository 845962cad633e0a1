// One sample of every stochastic quantity at each of many surface points.
//
// Follows one path of directions from each point x, a batch of paths side by side. At each vertex k = 0..K a path
// gathers the radiance that left a light and reached the vertex in one segment, by next-event estimation and, where
// emitters can be met, by the path's own next ray. What vertex k gathers, carried back to x, is `direct` for k = 0 and
// `indirect.k` for k > 0. The first ray also serves the ambient visibility. Where x has a specular lobe, or lets light
// pass, a second path leaves it that way and brings `reflection`.
//   Light that passes a transparent pane is dimmed but not scattered: the pane is no vertex, nor the end of a segment.
//   Good for: all planes in one go. Nothing is traced that no wanted plane needs.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "frames/quantities.h"
#include "pathtracer/light_table.h"
#include "pathtracer/path_batch.h"
#include "pathtracer/scattering.h"
#include "pathtracer/traced_scene.h"

namespace plumb {

// What has to be estimated; follows from the planes that are wanted and from what the scene holds.
struct EstimationPlan {
    bool ao = false, direct = false, indirect = false, irradiance = false, reflection = false;
    int bounces = 0;  // 0 where neither indirect light nor reflection is wanted
    float ao_radius = 1.0f;
    Falloff ao_falloff = Falloff::quadratic;
    float indirect_radius = infinite_distance;
    Falloff indirect_falloff = Falloff::hard;
    float reflection_radius = infinite_distance;
    Falloff reflection_falloff = Falloff::hard;
    // Lights without extent reach x without randomness through pixel centres; they are added exactly, once per pixel.
    bool exact_lights_at_first_point = true;
    int roulette_after = 0;  // bounces that every path is given; 0: no roulette
};

class PathIntegrator {
public:
    // `layers`: what rays that look for surfaces may meet (all: null); the way from a surface to a light is always that
    // of the whole scene.
    PathIntegrator(const TracedScene& scene, const LightTable& lights, const OracleLayers* layers,
                   const EstimationPlan& plan)
        : scene_(scene), lights_(lights), layers_(layers), plan_(plan) {}

    // Makes `x`, seen against `direction`, the start of path number `path`, which must be the batch's next one. Returns
    // the albedo of x's diffuse lobe, by which `radiance` is to be multiplied.
    glm::vec3 add_start(const SurfacePoint& x, const glm::vec3& direction, const SampleIndex& sample, float time,
                        VertexBatch& batch) const;

    // Makes the points that the rays in `met` found the starts of paths, the i-th of them of path i. `samples`: by ray.
    void start(const RayBatch& rays, const HitBatch& hits, const MetRays& met, const SampleLanes& samples,
               VertexBatch& starts) const;

    // Sets all of `estimate` that the plan wants, radiance for vertices 0..bounces.
    void estimate(const VertexBatch& starts, PathWorkspace& workspace, BatchEstimate& estimate) const;

    // The part of `direct` that lights without extent give, as if x's albedo were 1; deterministic. Counts rays.
    glm::vec3 exact_direct(const SurfacePoint& x, std::uint64_t& rays) const;

private:
    enum class Start { diffuse, specular };

    // At the first vertex the specular side alone, later all lobes but what passes, which is decided before.
    Scattering scattering(const VertexBatch& vertices, int lane, int vertex) const;
    void add_lobes(const RayBatch& rays, const HitBatch& hits, const MetRays& met, VertexBatch& vertices) const;
    void next_event(const VertexBatch& vertices, int vertex, Start start, PathWorkspace& workspace, VectorLanes& sum,
                    int& rays) const;
    void connect(const VertexBatch& vertices, int vertex, Start start, PathWorkspace& workspace, VectorLanes& sum,
                 int& rays) const;
    void scatter(const VertexBatch& vertices, int vertex, Start start, PathWorkspace& workspace, int& rays) const;
    void draw_directions(const VertexBatch& vertices, int vertex, Start start, ScatteredRays& scattered,
                         Lanes<std::uint8_t>& passes) const;
    // Sets `open` to 0 where a way above the vertex (`rise` > 0) is wanted that something is in.
    void close_hidden_bulges(const VertexBatch& vertices, const Lanes<float>& rise, ShadowRays& to_bulges,
                             Lanes<float>& open, int& rays) const;
    void pass_panes(const VertexBatch& vertices, int vertex, Start start, ScatteredRays& scattered, HitBatch& hits,
                    int& rays) const;
    // How much what arrives at the first vertex from that far counts; infinity: from the background.
    float counted(Start start, float distance) const;
    bool is_limited(Start start, int vertex) const {
        const float radius = start == Start::diffuse ? plan_.indirect_radius : plan_.reflection_radius;
        return vertex == 0 && radius < infinite_distance;
    }
    bool survives_roulette(const SampleIndex& sample, int vertex, Start start, glm::vec3& throughput) const;
    void follow(const VertexBatch& starts, Start start, PathWorkspace& workspace, BatchEstimate& estimate) const;
    // Adds what each path finds where its ray arrived, and to `next` the vertices of those that go on.
    void arrive(const VertexBatch& from, int vertex, Start start, bool looks_for_emitters, PathWorkspace& workspace,
                VectorLanes& sum, VertexBatch& next) const;
    float obscurance(float distance) const { return evaluate_falloff(plan_.ao_falloff, distance, plan_.ao_radius); }

    const TracedScene& scene_;
    const LightTable& lights_;
    const OracleLayers* layers_;
    EstimationPlan plan_;
};

}  // namespace plumb

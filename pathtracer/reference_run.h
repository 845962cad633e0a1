// One reference in progress: samples in passes, progress, checkpoints, and the planes in the end.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "pathtracer/accumulation.h"
#include "pathtracer/checkpoint.h"
#include "pathtracer/environment_distribution.h"
#include "pathtracer/light_table.h"
#include "pathtracer/oracle_layers.h"
#include "pathtracer/path_integrator.h"
#include "pathtracer/reference.h"
#include "pathtracer/reference_plan.h"
#include "pathtracer/tile_sampler.h"

namespace plumb {

struct SampledReference::Parts {
    ReferenceResult result;               // without what `planes` will add
    std::vector<StochasticPlane> planes;  // that the sums are for
    Accumulation sums;
    ExactParts exact;
    int threads = 0;  // 0: all
};

class ReferenceRun {
public:
    // Keeps references to all.
    ReferenceRun(const TracedScene& scene, const EnvironmentDistribution& environment, const View& view,
                 const ReferenceSettings& settings);

    // The sums go with the parts: nothing may be asked afterwards, nor after merge().
    SampledReference::Parts run(const ReferenceControl& control);
    // Renders the samples that are asked for and leaves their sums in `file`. False where it was stopped before the
    // end.
    bool run_shard(const std::filesystem::path& file, const ReferenceControl& control);
    // All samples that the files hold together.
    SampledReference::Parts merge(const std::vector<std::filesystem::path>& shards);

private:
    void find_exact_parts();
    bool has_noise() const;
    bool sample(const ReferenceControl& control);  // false: stopped
    void resume(const ReferenceControl& control);
    CheckpointKey key() const;
    double worst_error() const;
    SampledReference::Parts finish(bool complete);
    int samples_done() const { return state_.end - state_.begin; }

    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
    const TracedScene& scene_;
    const View& view_;
    const ReferenceSettings& settings_;
    RenderPlan plan_;
    LightTable lights_;
    std::optional<OracleLayers> layers_;
    PathIntegrator integrator_;
    Accumulation accumulation_;
    std::vector<SurfaceHit> hits_;  // of the rays through the pixels' centres, where anything asks for them
    TileSampler sampler_;
    ExactParts exact_;
    CheckpointState state_;
};

}  // namespace plumb

// One reference in progress: samples in passes, progress, checkpoints, and the planes in the end.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <tbb/enumerable_thread_specific.h>

#include "pathtracer/accumulation.h"
#include "pathtracer/checkpoint.h"
#include "pathtracer/environment_distribution.h"
#include "pathtracer/light_table.h"
#include "pathtracer/oracle_layers.h"
#include "pathtracer/path_integrator.h"
#include "pathtracer/reference.h"
#include "pathtracer/reference_plan.h"

namespace plumb {

class ReferenceRun {
public:
    // Keeps references to all.
    ReferenceRun(const TracedScene& scene, const EnvironmentDistribution& environment, const View& view,
                 const ReferenceSettings& settings);

    ~ReferenceRun();

    ReferenceResult run(const ReferenceControl& control);
    // Renders the samples that are asked for and leaves their sums in `file`. False where it was stopped before the
    // end.
    bool run_shard(const std::filesystem::path& file, const ReferenceControl& control);
    // The planes of all samples that the files hold together.
    ReferenceResult merge(const std::vector<std::filesystem::path>& shards);

private:
    struct Scratch;

    void find_exact_parts();
    bool has_noise() const;
    bool sample(const ReferenceControl& control);  // false: stopped
    void resume(const ReferenceControl& control);
    void render_pass(int first_sample, int count);
    void render_tile(int tile, int first_sample, int count, Scratch& scratch);
    void add_centre_samples(int left, int right, int y, int first_sample, int count, Scratch& scratch);
    void add_centre_samples(int x, int y, const SurfacePoint& point, const glm::vec3& direction, int first_sample,
                            int count, Scratch& scratch);
    void add_spread_samples(int x, int y, int first_sample, int count, Scratch& scratch);
    void make_primary_rays(Scratch& scratch) const;
    void trace_primary_rays(Scratch& scratch);
    void flush(Scratch& scratch);
    double worst_error() const;
    ReferenceResult finish(bool complete);  // the sums are gone afterwards
    int samples_done() const { return state_.end - state_.begin; }
    std::size_t pixel_index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width()) + static_cast<std::size_t>(x);
    }

    const TracedScene& scene_;
    const View& view_;
    const ReferenceSettings& settings_;
    RenderPlan plan_;
    LightTable lights_;
    std::optional<OracleLayers> layers_;
    PathIntegrator integrator_;
    Accumulation accumulation_;
    std::vector<SurfaceHit> hits_;
    ExactParts exact_;
    CheckpointKey key_;
    CheckpointState state_;
    tbb::enumerable_thread_specific<std::unique_ptr<Scratch>> scratch_;
};

}  // namespace plumb

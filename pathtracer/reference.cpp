#include "pathtracer/reference.h"

#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "pathtracer/environment_distribution.h"
#include "pathtracer/exact_gbuffer.h"
#include "pathtracer/reference_error.h"
#include "pathtracer/reference_run.h"
#include "pathtracer/traced_scene.h"

namespace plumb {
namespace {

int arena_size(int threads) {
    if (threads < 0)
        throw ReferenceError(fmt::format("{} threads: the number must not be negative; 0 means all", threads));
    return threads == 0 ? tbb::task_arena::automatic : threads;
}

}  // namespace

struct PathTracer::Implementation {
    Implementation(const Scene& scene, const TimeSpan& span) : traced(scene, span), environment(scene) {}

    // Runs `use` on a run of these settings, on that many threads.
    template <typename Use>
    auto with_run(const View& view, const ReferenceSettings& settings, int threads, const Use& use) const {
        tbb::task_arena arena(arena_size(threads));
        return arena.execute([&] {
            ReferenceRun run(traced, environment, view, settings);
            return use(run);
        });
    }
    template <typename Use>
    SampledReference sampled(const View& view, const ReferenceSettings& settings, int threads, const Use& use) const {
        auto parts = std::make_unique<SampledReference::Parts>(with_run(view, settings, threads, use));
        parts->threads = threads;
        return SampledReference(std::move(parts));
    }

    TracedScene traced;
    EnvironmentDistribution environment;
};

PathTracer::PathTracer(const Scene& scene, const TimeSpan& span)
    : implementation_(std::make_unique<Implementation>(scene, span)) {}
PathTracer::~PathTracer() = default;
PathTracer::PathTracer(PathTracer&&) noexcept = default;

SampledReference::SampledReference(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
SampledReference::~SampledReference() = default;
SampledReference::SampledReference(SampledReference&&) noexcept = default;

ReferenceResult SampledReference::result() && {
    ReferenceResult& result = parts_->result;
    tbb::task_arena(arena_size(parts_->threads)).execute([&] {
        parts_->sums.write(parts_->planes, result.samples, std::move(parts_->exact), result.frame);
    });
    return std::move(result);
}

SampledReference PathTracer::sample(const View& view, const ReferenceSettings& settings,
                                    const ReferenceControl& control) const {
    return implementation_->sampled(view, settings, control.threads,
                                    [&](ReferenceRun& run) { return run.run(control); });
}

bool PathTracer::render_shard(const View& view, const ReferenceSettings& settings, const std::filesystem::path& file,
                              const ReferenceControl& control) const {
    return implementation_->with_run(view, settings, control.threads,
                                     [&](ReferenceRun& run) { return run.run_shard(file, control); });
}

SampledReference PathTracer::merge(const View& view, const ReferenceSettings& settings,
                                   const std::vector<std::filesystem::path>& shards, int threads) const {
    return implementation_->sampled(view, settings, threads, [&](ReferenceRun& run) { return run.merge(shards); });
}

void PathTracer::set_recorder(RayRecorder* recorder) { implementation_->traced.set_recorder(recorder); }

Frame PathTracer::gbuffer(const View& view, const LayerSettings& settings, int threads) const {
    if (settings.layers < 1 || settings.layers > 99) {
        throw ReferenceError(fmt::format("{} layers: the number must lie between 1 and 99", settings.layers));
    }
    if (!(settings.minimum_separation >= 0.0f)) {
        throw ReferenceError(fmt::format("minimum separation {} m must not be negative", settings.minimum_separation));
    }
    Frame frame(view.width(), view.height());
    tbb::task_arena arena(arena_size(threads));
    arena.execute([&] {
        std::vector<SurfaceHit> hits = first_layer(implementation_->traced, view);
        for (int layer = 1; layer <= settings.layers; ++layer) {
            if (layer > 1) hits = next_layer(implementation_->traced, view, hits, settings.minimum_separation);
            const std::string prefix = layer == 1 ? "" : fmt::format("layer{}.", layer);
            for (const char* plane :
                 {"depth", "normal", "albedo", "position", "motion", "instance", "emission", "seen_before"}) {
                write_gbuffer_plane(implementation_->traced, view, settings.previous_view, hits, prefix + plane, frame);
            }
        }
    });
    return frame;
}

}  // namespace plumb

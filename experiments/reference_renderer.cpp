#include "experiments/reference_renderer.h"

#include <algorithm>

#include <fmt/format.h>

namespace plumb {

ReferenceResult ReferenceRenderer::render(const PathTracer& tracer, const Scene& scene, const View& view,
                                          const ReferenceSettings& settings, const ReferenceName& name,
                                          const ProgressPart& part, RunResults& results, const TimeSpan& span) const {
    const std::string what = fmt::format("{}: {}, truth ({})", name.scene, name.view, name.truth);
    ReferenceControl control;
    control.threads = threads_;
    control.stop = stop_;
    control.on_progress = [&](const ReferenceProgress& progress) {
        const double done = static_cast<double>(progress.samples_done) / std::max(1, progress.samples_wanted);
        progress_.show(part.at(done),
                       fmt::format("{}: {} of {} samples, {:.1f} M rays/s, error {:.2g}", what, progress.samples_done,
                                   progress.samples_wanted, progress.rays_per_second * 1e-6, progress.relative_error));
    };
    CachedReference cached = cache_.get(
        reference_key(scene, view, settings, span),
        [&](const std::filesystem::path& checkpoint) {
            control.checkpoint = checkpoint;
            return tracer.render(view, settings, control);
        },
        [&] { progress_.log(fmt::format("{}: another run renders it; waiting", what)); });
    if (!cached.warning.empty()) progress_.log("warning: " + cached.warning);
    results.references.push_back(
        {name.scene, name.view, name.truth, cached.result.samples, cached.result.seconds, cached.from_cache});
    return std::move(cached.result);
}

}  // namespace plumb

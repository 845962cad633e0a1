// References of a run: from the cache, or rendered with the progress shown, and on record either way.
#pragma once

#include <atomic>
#include <string>

#include "experiments/progress_line.h"
#include "experiments/reference_cache.h"
#include "experiments/results.h"
#include "pathtracer/reference.h"

namespace plumb {

// A part of a job, as fractions of the whole.
struct ProgressPart {
    double from = 0.0, to = 1.0;

    double at(double fraction) const { return from + (to - from) * fraction; }
    ProgressPart part(double first, double last) const { return {at(first), at(last)}; }
};

// What is rendered, by the names that progress and records show.
struct ReferenceName {
    std::string scene, view, truth;
};

class ReferenceRenderer {
public:
    // Keeps references to both; `threads` as ReferenceControl has it.
    ReferenceRenderer(const ReferenceCache& cache, ProgressLine& progress, const std::atomic<bool>* stop, int threads)
        : cache_(cache), progress_(progress), stop_(stop), threads_(threads) {}

    // `tracer` holds `scene` over `span`. An interrupted result is not complete. Throws what rendering throws.
    ReferenceResult render(const PathTracer& tracer, const Scene& scene, const View& view,
                           const ReferenceSettings& settings, const ReferenceName& name, const ProgressPart& part,
                           RunResults& results, const TimeSpan& span = {}) const;

private:
    const ReferenceCache& cache_;
    ProgressLine& progress_;
    const std::atomic<bool>* stop_;
    int threads_;
};

}  // namespace plumb

// One scene of an experiment: every view rendered by the path tracer and by every method, measured and timed.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "experiments/progress_line.h"
#include "experiments/reference_cache.h"
#include "experiments/results.h"
#include "experiments/view_truths.h"
#include "rasterizer/gl_context.h"
#include "rasterizer/pipeline.h"

namespace plumb {

// What a method or the path tracer made of one plane of one view.
struct PlaneImage {
    std::string view, plane, method;
    Image image;
    int path_tracer_samples = 0;
    Timing timing;
    int gbuffer_bytes_per_pixel = 0;
};

struct SceneRunControl {
    GlContext& context;
    const ReferenceCache& cache;
    ProgressLine& progress;
    const std::atomic<bool>* stop = nullptr;
    int threads = 0;                                // of the path tracer; 0: all
    double progress_from = 0.0, progress_to = 1.0;  // this scene's part of the whole run
};

class SceneRun {
public:
    // Keeps references to all of them.
    SceneRun(const Experiment& experiment, const ExperimentScene& entry, const Scene& scene,
             const SceneRunControl& control);

    // Renders and measures; appends rows, reference uses and failures to `results`. Returns early when stopped.
    void run(RunResults& results);

    const std::vector<std::string>& views() const { return views_; }
    const std::map<std::string, ViewTruths>& truths() const { return truths_; }
    const std::vector<PlaneImage>& images() const { return images_; }

private:
    bool stopped() const { return control_.stop && control_.stop->load(); }
    void show(double fraction, const std::string& text);
    double measuring_progress(const std::string& plane, double done) const;
    View view_of(const std::string& name) const;
    void render_truths(const std::string& view, RunResults& results);
    ReferenceResult render_reference(const std::string& view, const ReferenceSettings& settings,
                                     const std::string& truth, double fraction, RunResults& results);
    void render_methods(const std::string& plane, RunResults& results);
    void render_path_tracer_curve(const std::string& plane, RunResults& results);
    void measure(const PlaneImage& image, RunResults& results);

    const Experiment& experiment_;
    const ExperimentScene& entry_;
    const Scene& scene_;
    SceneRunControl control_;
    PathTracer tracer_;
    std::vector<std::string> views_;
    std::map<std::string, ViewTruths> truths_;
    std::vector<PlaneImage> images_;
};

}  // namespace plumb

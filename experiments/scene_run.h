// One scene of an experiment: every view rendered by the path tracer and by every method, measured and timed.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "experiments/cell_store.h"
#include "experiments/plane_image.h"
#include "experiments/reference_renderer.h"
#include "experiments/results.h"
#include "experiments/view_truths.h"
#include "metrics/regions.h"
#include "rasterizer/gl_context.h"
#include "rasterizer/pipeline.h"

namespace plumb {

struct SceneRunControl {
    GlContext& context;
    const ReferenceCache& cache;
    const CellStore& cells;
    ProgressLine& progress;
    const std::atomic<bool>* stop = nullptr;
    int threads = 0;    // of the path tracer; 0: all
    ProgressPart part;  // of the whole run, for this scene
};

class SceneRun {
public:
    // Keeps references to all of them.
    SceneRun(const Experiment& experiment, const ExperimentScene& entry, const Scene& scene,
             const SceneRunControl& control);

    // Renders and measures all views; appends rows, reference uses and failures to `results`. Returns early when
    // stopped.
    void run(RunResults& results);

    const std::vector<std::string>& views() const { return views_; }
    const std::map<std::string, ViewTruths>& truths() const { return truths_; }
    const std::vector<PlaneImage>& images() const { return images_; }

private:
    bool stopped() const { return control_.stop && control_.stop->load(); }
    void show(double fraction, const std::string& text);
    double measuring_progress(const std::string& plane, double done) const;
    View view_of(const std::string& name) const;
    std::string cell_key(const std::string& view, const std::string& plane) const;
    bool load_cell(const std::string& key);
    // For the next run, unless the key is empty.
    void keep_cell(const std::string& key, std::vector<PlaneImage> images);
    void render_truths(const std::string& view, RunResults& results);
    struct MethodOfPlane {
        std::string name;
        std::unique_ptr<Pipeline> pipeline;
        int frames_to_settle = 1;  // that are rendered, of which the last is measured
    };
    void render_methods(const std::string& plane, RunResults& results);
    std::vector<MethodOfPlane> make_pipelines(const std::string& plane, RunResults& results);
    void render_view(const std::string& view, const std::string& plane, const std::vector<MethodOfPlane>& methods,
                     const std::string& key, RunResults& results);
    void render_path_tracer_curve(const std::string& plane, RunResults& results);
    // At each number of samples, in turn.
    std::vector<PlaneImage> time_path_tracer(const std::string& view, const std::string& plane,
                                             ReferenceSettings settings);
    void render_oracle(const std::string& view, RunResults& results);
    void measure(const PlaneImage& image, RunResults& results);

    const Experiment& experiment_;
    const ExperimentScene& entry_;
    const Scene& scene_;
    SceneRunControl control_;
    PathTracer tracer_;
    ReferenceRenderer references_;
    std::vector<std::string> views_;
    std::map<std::string, ViewTruths> truths_;
    std::map<std::string, std::vector<Region>> regions_;
    std::vector<PlaneImage> images_;
};

// All that decides the pixels and times of the methods' images of a view.
std::string methods_key(const Experiment& experiment, const ExperimentScene& entry, const Scene& scene,
                        const View& view, const GlInfo& gl);

// The method and the sweep that a row of `method` belongs to.
void describe_method(const Experiment& experiment, const ExperimentScene& entry, const std::string& method,
                     ResultRow& row);

}  // namespace plumb

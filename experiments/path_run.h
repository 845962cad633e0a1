// One camera path of an experiment's scene: every frame rendered by the path tracer and, in turn, by every method as
// it would in motion, with its history, and by the oracle; the error over all frames, how steady it is, and where the
// camera stands still, how far it lags. Then the methods play the path once more, without the path tracer and without a
// picture, for their times (method_timing.h).
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "experiments/scene_run.h"

namespace plumb {

class PathRun {
public:
    // Keeps references to all of them. The path's pictures go into `folder`/pictures.
    PathRun(const Experiment& experiment, const ExperimentScene& entry, const Scene& scene, const ExperimentPath& path,
            const SceneRunControl& control, std::filesystem::path folder);
    ~PathRun();

    // Appends a row per plane and method, pictures, reference uses and failures to `results`. Returns early, without
    // rows, when stopped.
    void run(RunResults& results);

private:
    struct Series;

    bool stopped() const { return control_.stop && control_.stop->load(); }
    Moment at(int frame) const;
    TimeSpan span_to(int frame) const;  // from the frame before; empty where nothing moves
    ReferenceSettings truth_settings() const;
    // A frame's truth, or the oracle instead of it, as `part` of that frame's progress.
    ReferenceResult render_reference(int frame, const ReferenceSettings& settings, const std::string& truth,
                                     const ProgressPart& part, RunResults& results) const;
    std::string cell_key(int frame) const;
    // All frames that an earlier run kept; empty unless it kept every one. The first frame's cell is kept last, with
    // the times.
    std::vector<std::vector<PlaneImage>> load_cells() const;
    Series& series_of(const PlaneImage& image);
    Method method_of(const Series& series) const;  // as it runs in this scene
    void make_pipelines(RunResults& results);
    Frame render_truth(int frame, RunResults& results);
    FrameRequest request_for(int frame, const Frame& truth) const;
    std::vector<PlaneImage> render_methods(int frame, const Frame& truth, RunResults& results);
    // False where that failed, or the run was stopped.
    bool time_methods(RunResults& results);
    bool time_methods(const std::string& plane, RunResults& results);
    void keep_first_cell(std::vector<PlaneImage> images) const;
    // What every method shows at the moment of the last frame from then on, until it has settled: for each, the sum of
    // these pictures and the mean of the settled ones. Empty when stopped.
    std::vector<PlaneImage> render_held(const Frame& truth, RunResults& results);
    void add_held(const Frame& truth, RunResults& results);
    std::vector<PlaneImage> render_oracle(int frame, const Frame& truth, RunResults& results);
    void add(const PlaneImage& image, int frame, const Frame& truth, const std::vector<Region>& regions);
    void write_rows(RunResults& results);
    void write_pictures(RunResults& results);

    const Experiment& experiment_;
    const ExperimentScene& entry_;
    const Scene& scene_;
    const ExperimentPath& path_;
    SceneRunControl control_;
    std::filesystem::path folder_;
    ReferenceRenderer references_;
    bool scene_moves_ = false;
    bool tells_lag_ = false;  // the camera stands still, and the scene does not (metrics/path_lag.h)
    std::unique_ptr<PathTracer> tracer_;
    std::vector<std::unique_ptr<Series>> series_;  // by plane, then by method; the oracle's follow the methods'
    std::vector<std::vector<Image>> truths_;       // by plane, then by frame: for pictures
    std::vector<Frame> stage_truths_;              // by frame: what stages are fed with, empty where none is
    int reference_samples_ = 0;                    // the fewest of any frame
};

}  // namespace plumb

// What a run of an experiment found: one row per scene, view, plane, truth and method.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/experiment_file.h"
#include "experiments/no_value.h"
#include "experiments/system_facts.h"
#include "metrics/block_bootstrap.h"
#include "metrics/path_stability.h"
#include "rasterizer/pipeline.h"

namespace plumb {

struct Timing {
    double median = 0.0, lower_quartile = 0.0, upper_quartile = 0.0;  // milliseconds
    int repetitions = 0;
    std::vector<PassTiming> passes;  // medians; of the path tracer: one
};

// The error over some of a view's pixels (metrics/regions.h).
struct RegionError {
    std::string region;
    std::size_t pixels = 0;
    double mse = 0.0, mse_lower = 0.0, mse_upper = 0.0;  // free of the reference's noise where that is possible
    std::optional<PathStabilityResult> stability = {};   // of a path
    bool measured = true;                                // false: the reference's noise is too near to the difference
    std::vector<std::pair<std::string, double>> measures = {};  // as ResultRow has them
};

// One frame of a camera path.
struct FrameMeasure {
    double time = 0.0;     // seconds, on the path
    double rmse = 0.0;     // free of the reference's noise
    double flicker = 0.0;  // since the frame before; NaN for the first
};

// What the truth is limited to in a row of the oracle: the best that any method could make of it.
struct OracleLimits {
    int layers = -1;  // of the view, which rays may meet; 0: all in view; -1: no such limit
    int bounces = 0;  // of light, at most; 0: no such limit

    bool any() const { return layers >= 0 || bounces > 0; }
};

struct ResultRow {
    std::string scene, view, plane, method;
    std::string path;             // a camera path; `view` is empty then, and errors are over all of its frames
    std::string truth;            // which of two truths, for planes that have two; else empty
    int path_tracer_samples = 0;  // per pixel; 0: a method. The path tracer's own rows draw its curve
    Method parameters;            // as the method ran in this scene

    bool measured = false;                                 // false: the reference's noise is too near to the difference
    std::string refusal;                                   // then: how many samples would do
    std::vector<std::pair<std::string, double>> measures;  // under the names of metrics/comparison.h
    // Free of the reference's noise where that is possible. The interval is for views and seeds like these.
    double mse = 0.0, mse_lower = 0.0, mse_upper = 0.0;
    int seeds = 1;  // pictures that all of this is the mean of
    double seeds_mse_lower = no_value,
           seeds_mse_upper = no_value;                         // for this very view, over seeds alone; NaN for one seed
    std::vector<std::pair<std::string, Estimate>> over_seeds;  // likewise, of the measures; empty for one seed
    double psnr = 0.0, ssim = 0.0;                             // NaN where there is none; psnr free of noise as mse is
    double noise_mse = 0.0;                                    // of the reference
    double data_range = 1.0;                                   // peak of PSNR, range of SSIM
    int reference_samples = 0;                                 // per pixel
    std::vector<RegionError> regions;
    // Of planes of the G-buffer: what metrics/gbuffer_fidelity.h says of that plane.
    std::vector<std::pair<std::string, double>> fidelity;
    std::vector<FrameMeasure> frames;              // of a path
    std::optional<PathStabilityResult> stability;  // of a path
    std::optional<Estimate> lag;  // frames, of a path with a still camera where something moves (metrics/path_lag.h)

    std::string curve, curve_parameter;  // of a method that a sweep made; empty: none
    double curve_value = 0.0;
    OracleLimits oracle;  // of the rows of the oracle, which take no time

    Timing timing;
    int gbuffer_bytes_per_pixel = 0;  // as far as this plane needs a G-buffer; the path tracer's rows: 0

    bool is_method() const { return path_tracer_samples == 0 && !oracle.any(); }
    const std::string& place() const { return path.empty() ? view : path; }
    double rmse() const;
    double rmse_lower() const;
    double rmse_upper() const;
};

// NaN where no measure has the name.
double measure_named(const std::vector<std::pair<std::string, double>>& measures, std::string_view name);

// What the oracle's rows are called: "oracle, 2 layers", "oracle, all in view" for 0.
std::string oracle_name(int layers);
// "oracle, 2 bounces".
std::string oracle_name_of_bounces(int bounces);

struct Picture {
    std::string label;        // "truth" or a method's name
    std::string kind;         // "truth", "method" or "error"
    std::string file;         // relative to the results folder
    std::string note;         // "RMSE 0.03, 12 ms"
    std::string values = {};  // of truth and methods: the packed plane (packed_plane.h), relative to the same folder
};

// The pictures of one view and plane, alike in exposure, and their error maps, alike in scale.
struct PictureSet {
    std::string scene, view, plane, truth;
    double error_scale = 1.0;   // the error that takes the map's last colour
    float exposure = 0.0f;      // stops
    std::string exposure_note;  // how radiance became a picture
    std::vector<Picture> images;
};

// What a method, the truth or an error map shows along a camera path, one picture per frame.
struct PathPictureStrip {
    std::string label;               // "truth" or a method's name
    std::string kind;                // "truth", "method" or "error"
    std::vector<std::string> files;  // relative to the results folder
    std::vector<double> rmse;        // per frame; of a method
    std::vector<double> flicker;     // per frame, NaN for the first; of a method
};

struct PathPictures {
    std::string scene, path, plane, truth;
    double frames_per_second = 30.0;
    double error_scale = 1.0;
    std::string exposure_note;
    std::vector<PathPictureStrip> strips;
};

// A step from one error to the next; `change_...` bounds the step with 95 %, NaN where that is not known.
struct WaterfallBar {
    std::string label;
    double from = 0.0, to = 0.0;
    double change_lower = 0.0, change_upper = 0.0;
    std::string note;  // "saves 12 ms"
};

// Each bar begins where the one before it ends: what one approximation after the other adds.
struct Waterfall {
    std::string title;  // "clutter / shelf / ao: two_layers"
    std::string axis;   // "RMSE"
    std::vector<WaterfallBar> bars;
};

struct CellFailure {
    std::string cell;  // "cornell / front / ao / two_layers"
    std::string message;
};

struct ReferenceUse {
    std::string scene, view, truth;
    int samples = 0;
    double seconds = 0.0;  // of rendering it, then or now
    bool from_cache = false;
};

struct RunResults {
    Experiment experiment;
    SystemFacts system;
    std::string experiment_text;  // the experiment's file as it was read: what runs it again
    std::string command;          // as typed
    std::string started;          // UTC, ISO 8601
    std::string gl_backend, gl_vendor, gl_renderer, gl_version;
    bool gl_software = true;
    double seconds = 0.0;
    bool interrupted = false;
    std::vector<ResultRow> rows;
    std::vector<PictureSet> pictures;
    std::vector<PathPictures> path_pictures;
    std::vector<Waterfall> waterfalls;
    std::vector<ReferenceUse> references;
    std::vector<CellFailure> failures;
    std::map<std::string, std::string> scene_hashes;
    std::vector<std::string> summary;  // sentences (summary.h)
};

}  // namespace plumb

// What a run of an experiment found: one row per scene, view, plane, truth and method.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "experiments/experiment_file.h"
#include "experiments/system_facts.h"
#include "rasterizer/pipeline.h"

namespace plumb {

struct Timing {
    double median = 0.0, lower_quartile = 0.0, upper_quartile = 0.0;  // milliseconds
    int repetitions = 0;
    std::vector<PassTiming> passes;  // medians; of the path tracer: one
};

struct ResultRow {
    std::string scene, view, plane, method;
    std::string truth;            // which of two truths, for planes that have two; else empty
    int path_tracer_samples = 0;  // per pixel; 0: a method. The path tracer's own rows draw its curve
    Method parameters;            // as the method ran in this scene

    bool measured = false;                                 // false: the reference's noise is too near to the difference
    std::string refusal;                                   // then: how many samples would do
    std::vector<std::pair<std::string, double>> measures;  // under the names of metrics/comparison.h
    double mse = 0.0, mse_lower = 0.0, mse_upper = 0.0;    // free of the reference's noise where that is possible
    double psnr = 0.0, ssim = 0.0;                         // NaN where there is none
    double noise_mse = 0.0;                                // of the reference
    double data_range = 1.0;                               // peak of PSNR, range of SSIM
    int reference_samples = 0;                             // per pixel

    Timing timing;
    int gbuffer_bytes_per_pixel = 0;  // as far as this plane needs a G-buffer; the path tracer's rows: 0

    double rmse() const;
    double rmse_lower() const;
    double rmse_upper() const;
};

struct Picture {
    std::string label;  // "truth" or a method's name
    std::string kind;   // "truth", "method" or "error"
    std::string file;   // relative to the results folder
    std::string note;   // "RMSE 0.03, 12 ms"
};

// The pictures of one view and plane, alike in exposure, and their error maps, alike in scale.
struct PictureSet {
    std::string scene, view, plane, truth;
    double error_scale = 1.0;   // the error that takes the map's last colour
    std::string exposure_note;  // how radiance became a picture
    std::vector<Picture> images;
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
    std::string command;  // as typed
    std::string started;  // UTC, ISO 8601
    std::string gl_backend, gl_vendor, gl_renderer, gl_version;
    bool gl_software = true;
    double seconds = 0.0;
    bool interrupted = false;
    std::vector<ResultRow> rows;
    std::vector<PictureSet> pictures;
    std::vector<ReferenceUse> references;
    std::vector<CellFailure> failures;
    std::map<std::string, std::string> scene_hashes;
    std::vector<std::string> summary;  // sentences (summary.h)
};

}  // namespace plumb

// Runs an experiment from its first reference to its page.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "experiments/loaded_scenes.h"
#include "experiments/results.h"
#include "rasterizer/gl_context.h"

namespace plumb {

struct RunOptions {
    std::filesystem::path output;     // results folder
    std::filesystem::path cache_dir;  // of references
    GlBackend backend = GlBackend::automatic;
    int threads = 0;  // of the path tracer; 0: all
    bool write_frames = true;
    std::string command;                      // as typed, for the record
    std::string experiment_text;              // the experiment's file, for the record
    const std::atomic<bool>* stop = nullptr;  // ends the run after the current pass; what was done is written
};

// Each scene is loaded once, and released when it is done. A cell that fails is listed in the results and does not end
// the run. Writes the files of result_files.h and the pictures and frames into the results folder. Throws
// GlUnavailable, and ImageError where the results folder cannot be written.
RunResults run_experiment(const Experiment& experiment, LoadedScenes& scenes, const RunOptions& options);

}  // namespace plumb

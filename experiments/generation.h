// An experiment of kind "generation": the second layer that each method draws, held against the exact one along camera
// paths. Written in TOML (experiments/generation.toml is an example).
//
// Every frame of a walk is rendered by each method, told of the frames before and after it, and by rays through the
// pixels' centres (PathTracer::gbuffer). Counted, over all frames but the first, which is a cut:
//
//   wrong       pixels whose second layer is another surface than the exact one, or none, or one where there is none:
//               depths differ by more than a thousandth
//   inside      the same away from silhouettes of the exact layers, where a shift by the rasteriser's sub-pixel grid
//               cannot matter
//   missing     pixels without a second layer where there is one
//   violations  second layers that lie less than the minimum separation behind the method's own first layer
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/method_file.h"
#include "experiments/runner.h"
#include "experiments/system_facts.h"

namespace plumb {

struct GenerationWalk {
    std::string name;
    std::string scene;
    std::string path;                 // of the scene's camera paths
    double start = 0.0;               // seconds, on the path
    double camera_speed = 1.0;        // times that of the path; 0: the camera stands still
    double object_speed = 0.0;        // times that of the scene's motions; 0: they stay where the scene has them
    float minimum_separation = 0.1f;  // metres
};

struct GenerationExperiment {
    std::string name, title, question;
    std::filesystem::path file;
    int width = 320, height = 180;
    int frames = 12;  // per walk, with the first
    double frames_per_second = 30.0;
    std::vector<GenerationWalk> walks;
    MethodList methods;
};

// Throws ConfigError with file and line.
GenerationExperiment parse_generation(const ConfigValue& table, const std::filesystem::path& file);
void make_quick(GenerationExperiment& experiment);

struct GenerationRow {
    std::string walk, method;
    double pixels_per_frame = 0.0;                                      // mean length of the exact motion vectors
    double wrong = 0.0, inside = 0.0, missing = 0.0, violations = 0.0;  // fractions of the pixels counted
    double milliseconds = 0.0;  // median, of the passes whose names begin with "gbuffer"
    int bytes_per_pixel = 0;
};

struct GenerationResults {
    GenerationExperiment experiment;
    SystemFacts system;
    std::string command, started, gl_renderer;
    double seconds = 0.0;
    bool interrupted = false;
    std::vector<GenerationRow> rows;    // by walk, then by method
    std::vector<CellFailure> failures;  // walks that could not be finished
};

// A walk that fails is listed in the results and does not end the run. Throws GlUnavailable.
GenerationResults run_generation(const GenerationExperiment& experiment, const SceneFinder& finder,
                                 const RunOptions& options);

std::string print_generation_table(const GenerationResults& results);
// generation.csv and generation.json, each whole or not at all. Throws ImageError.
void write_generation_files(const GenerationResults& results, const std::filesystem::path& folder);

}  // namespace plumb

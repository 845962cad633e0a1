// A run as its results.json tells it, to be run again and held against what it found then.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "experiments/results.h"

namespace plumb {

struct RecordedRun {
    Experiment experiment;
    std::string experiment_text;
    std::string git_describe, integrator_hash, gl_renderer;
    std::map<std::string, std::string> scene_hashes;
    // By "scene / view or path / plane / truth / method": everything that the file says of it but its times, as the
    // file writes it, by names such as "measures.rmse", "regions.border.unbiased_mse" and "frames.2.flicker".
    std::map<std::string, std::map<std::string, std::string>> rows;
};

// Throws ConfigError for a file that is no results.json of a comparison, and for one that holds no experiment.
RecordedRun read_recorded_run(const std::filesystem::path& file);

struct RunDifference {
    int rows = 0, same = 0;               // on record; the same bit for bit
    std::vector<std::string> rows_apart;  // one line for each that is not the same bit for bit, with the first value
                                          // that differs
    std::vector<std::string> causes;      // what else is not as it was: program, OpenGL, scenes
};

// Times are not compared: they never come out the same.
RunDifference difference(const RecordedRun& recorded, const RunResults& results);

}  // namespace plumb

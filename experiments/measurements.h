// What a reproduction measured, kept as a file, so that figures, tables and claims can be made again without rendering.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/measured_cells.h"

namespace plumb {

struct Measurements {
    std::string experiment;
    std::string command, started, renderer, cpu;
    double seconds = 0.0;
    bool quick = false;        // a trial run, which proves nothing
    bool interrupted = false;  // then incomplete, and never kept
    std::string program;       // version, and git's description of its sources
    std::string key;           // of what was measured with what (reproduction_key.h)
    std::vector<Cell> cells;
    std::vector<PictureSet> pictures;   // files relative to the folder `run` beside the kept file
    std::vector<std::string> left_out;  // scenes that are not here, with the reason; without folders of this machine
    std::vector<CellFailure> failures;
};

std::string print_measurements_json(const Measurements& measurements);
// Throws ConfigError for a file that is not one.
Measurements read_measurements_json(const std::filesystem::path& file);

}  // namespace plumb

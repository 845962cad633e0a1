// How much disk a comparison will take, told before it starts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "experiments/experiment_file.h"
#include "experiments/loaded_scenes.h"

namespace plumb {

// At most: files are compressed, which saves a third or so.
struct DiskUse {
    std::uintmax_t cache = 0;   // references, kept for other runs
    std::uintmax_t output = 0;  // frames, pictures and, while it runs, finished cells
};

// Loads the scenes whose views the experiment does not name; those that cannot be loaded count for nothing.
DiskUse disk_use(const Experiment& experiment, LoadedScenes& scenes, bool write_frames);

// "at most 0.2 GB of references and 0.1 GB of results"
std::string print_disk_use(const DiskUse& use);

// One line, with the space that is free. Throws ImageError that says what to do where it does not suffice.
std::string describe_disk_use(const DiskUse& use, const std::filesystem::path& cache,
                              const std::filesystem::path& output);

}  // namespace plumb

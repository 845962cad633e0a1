// An experiment of kind "convergence": how the path tracer's error falls with its samples, for random and for Sobol
// points. Written in TOML (experiments/convergence.toml is an example).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/config.h"
#include "frames/quantities.h"

namespace plumb {

struct ConvergenceScene {
    std::string scene;       // a built-in scene's name or a scene file
    std::string view;        // camera name; empty: the first
    float ao_radius = 1.0f;  // metres
};

struct ConvergenceExperiment {
    std::string name;
    std::string title;
    std::string question;
    std::filesystem::path file;
    std::vector<std::string> planes = {"ao", "direct", "indirect"};
    int width = 96, height = 54;
    Quantities quantities;  // `planes` and `ao_radius` are those above and of the scenes
    std::vector<int> samples = {4, 8, 16, 32, 64, 128, 256, 512, 1024};  // per pixel, even, ascending
    int seeds = 4;                                                       // runs at each number of samples
    int reference_samples = 8192;
    // A point is left out of the fit where the reference's mean squared noise is above this share of its error.
    double most_noise = 0.5;
    std::vector<ConvergenceScene> scenes;
};

// Throws ConfigError with file and line.
ConvergenceExperiment parse_convergence(const ConfigValue& table, const std::filesystem::path& file);

// The same question at a small size, for trying it out.
void make_quick(ConvergenceExperiment& experiment);

}  // namespace plumb

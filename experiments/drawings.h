// Figures that explain a method rather than measure it: the spiral of taps, and what the Gaussian filter makes of one
// white pixel. Files of kind "drawing" hold them (experiments/reproduce/thesis-drawings.toml), which `plumbline
// reproduce` alone takes.
//
//     [[drawings]]
//     title = "The spiral"
//     source = "000, figure 2.4"
//     drawing = "spiral"                  # or "filter"
//     [[drawings.spirals]]                # one panel each
//     samples = 23
//     turns = 5                           # by default those that suit the samples (sample_spiral.h)
//     spin = 0.25                         # turns by which all taps are rotated
//
//     [[drawings]]
//     drawing = "filter"
//     size = 11                           # pixels across the black square with one white pixel in its middle
//     radius = 5                          # of the filter; the standard deviation is a third of it
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/config.h"
#include "experiments/result_table.h"

namespace plumb {

struct SpiralDrawing {
    int samples = 23;
    int turns = 0;      // 0: those that suit the samples
    double spin = 0.0;  // turns
};

struct Drawing {
    std::string title, source;
    enum class Kind { spiral, filter } kind = Kind::spiral;
    std::vector<SpiralDrawing> spirals;
    int size = 11, radius = 5;  // of filters
};

bool is_drawing_file(const ConfigValue& table);
// Throws ConfigError with file and line. Keys of other readers are refused.
std::vector<Drawing> parse_drawings(const ConfigValue& table, const std::filesystem::path& file);

// As SVG; for terminals and programs, as numbers.
std::string print_drawing(const Drawing& drawing);
ResultTable drawing_numbers(const Drawing& drawing);

}  // namespace plumb

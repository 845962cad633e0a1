// What a run found, flat: one cell per scene, view, plane, truth and method, with everything that was measured under a
// name. Figures, the seeds' own numbers and claims are made from cells alone, whichever kind of experiment they are of,
// and cells can be kept and read again.
//
// Measures of a cell:
//   rmse, mse            free of the reference's noise where that is possible; none where a comparison was refused
//   bias, psnr, ssim...  the names of metrics/comparison.h
//   rmse in REGION       the same over some of the pixels (metrics/regions.h); along paths also flicker in REGION
//   flicker, warping, truth warping, temporal variance     of camera paths
//   lag                  in frames, of camera paths that stand still while something moves (metrics/path_lag.h)
//   ms, ms of PASS       median time of the frame and of one pass
//   bytes per pixel      of the G-buffer
//   wrong, wrong inside, missing, violations               of second layers (generation.h), as fractions of the pixels
//   light fragments, confidence...   counted where they are asked for (counted_measures.h)
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/generation.h"
#include "experiments/results.h"

namespace plumb {

struct Cell {
    std::string scene;
    std::string place;  // a view, a camera path, or a walk
    std::string plane;
    std::string truth;   // "full", "limited", or empty where a plane has one truth only
    std::string method;  // a method, "oracle..." or "path tracer..."
    std::string curve;   // of methods that differ in one parameter; "path tracer" over its samples, "oracle, bounces"
    double parameter = std::numeric_limits<double>::quiet_NaN();  // where on the curve
    std::vector<std::pair<std::string, double>> values = {};      // measures that are finite

    void set(std::string name, double value);
};

// Names of the attributes that tell cells apart: scene, place, plane, truth, method, curve, parameter.
const std::vector<std::string>& cell_attributes();
// An attribute as text, the parameter with six digits at most; empty where there is none. Throws std::out_of_range for
// other names.
std::string attribute_of(const Cell& cell, std::string_view attribute);

// A measure by name; "ms of gbuffer*" is the sum of all whose names begin so; "A / B" of two measures is one too, and
// so are products, sums and differences, worked out from left to right. NaN where a part is missing.
double measure_of(const Cell& cell, std::string_view measure);

std::vector<Cell> cells_of(const RunResults& results);
std::vector<Cell> cells_of(const GenerationResults& results);

// One line per cell, all measures as columns.
std::string print_cells_csv(const std::vector<Cell>& cells);

}  // namespace plumb

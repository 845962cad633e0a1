// How many fragments the lights shade, counted beside a run because counting takes time: for the question what light
// volumes save.
#pragma once

#include <string_view>
#include <vector>

#include "experiments/experiment_file.h"
#include "experiments/measured_cells.h"
#include "experiments/scene_finder.h"
#include "rasterizer/gl_context.h"

namespace plumb {

inline constexpr std::string_view light_fragments_measure = "light fragments";

// Adds the measure to every cell of a view and method of the experiment. Throws what loading and rendering throw.
void add_light_fragments(const Experiment& experiment, const SceneFinder& finder, GlBackend backend,
                         std::vector<Cell>& cells);

}  // namespace plumb

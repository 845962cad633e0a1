// Measures that are counted beside a run, where a figure or claim asks for them: counting takes time, and planes that
// no method is timed with.
//
//   light fragments        fragments that the lights shade (rasterizer/light_fragment_count.h)
//   shadow map bytes       of all shadow maps together
//   depth complexity       surfaces along a pixel's ray, on average (exact_surfaces.h)
//   back faces             share of the exact second layer that turns its back, at the method's separation
//   depth normal degrees   how far normals of faces, made from depth, are off where surfaces are flat (depth_normals.h)
//   confidence             of radiosity, on average over the surfaces that are seen: the share of its taps that hit
//   confidence in REGION   the same over some of them: the regions of metrics/regions.h, and `near_half` and
//   `far_half`,
//                          on either side of the median depth
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "experiments/experiment_file.h"
#include "experiments/loaded_scenes.h"
#include "experiments/measured_cells.h"
#include "rasterizer/gl_context.h"

namespace plumb {

// Adds those measures for whose first word or words `is_asked_for` is true to every cell of a view and method of the
// experiment. Throws what loading and rendering throw.
void add_counted_measures(const Experiment& experiment, LoadedScenes& scenes, GlBackend backend,
                          const std::function<bool(std::string_view)>& is_asked_for, std::vector<Cell>& cells);

}  // namespace plumb

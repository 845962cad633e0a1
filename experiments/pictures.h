// The pictures of a run: truth, methods and error maps of every view and plane, as PNG files.
#pragma once

#include <filesystem>

#include "experiments/scene_run.h"
#include "frames/colour_map.h"

namespace plumb {

// The colour map of all error maps.
inline constexpr ColourMap error_colour_map = ColourMap::inferno;

// Writes the pictures of `run` into `folder`/pictures and lists them in `results`. Radiance of a view is exposed so
// that the truth's 99th percentile is nearly white, the same for all methods; error maps of a scene, plane and truth
// share one scale. The path tracer's own images are not pictured. Throws ImageError.
void write_pictures(const SceneRun& run, const Experiment& experiment, const std::string& scene,
                    const std::filesystem::path& folder, RunResults& results);

// Writes `folder`/frames/SCENE.VIEW.truth.exr (with half-buffers), ...limited_truth.exr, and one EXR per method.
void write_frames(const SceneRun& run, const Experiment& experiment, const std::string& scene,
                  const std::filesystem::path& folder);

// A name as part of a file's name: everything but letters, digits, '-' and '_' becomes '_'.
std::string file_name_of(std::string_view name);

}  // namespace plumb

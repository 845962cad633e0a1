// The pictures of a run's views: truth, methods and error maps of every view and plane, as PNG files, and beside them
// the values of truth and methods as packed planes, which the page shows.
#pragma once

#include <filesystem>

#include "experiments/picture_look.h"
#include "experiments/scene_run.h"

namespace plumb {

// Writes the pictures of `run` into `folder`/pictures and lists them in `results`. Radiance of a view is exposed so
// that the truth's 99th percentile is nearly white, the same for all methods; error maps of a scene, plane and truth
// share one scale. The path tracer's and the oracle's own images are not pictured. Throws ImageError.
void write_pictures(const SceneRun& run, const Experiment& experiment, const std::string& scene,
                    const std::filesystem::path& folder, RunResults& results);

// Writes `folder`/frames/SCENE.VIEW.truth.exr (with half-buffers), ...limited_truth.exr, and one EXR per method.
void write_frames(const SceneRun& run, const Experiment& experiment, const std::string& scene,
                  const std::filesystem::path& folder);

}  // namespace plumb

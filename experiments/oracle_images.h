#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/experiment_file.h"
#include "experiments/plane_image.h"
#include "pathtracer/reference.h"

namespace plumb {

// How one of the oracle's images is rendered, under its name. A result that is not complete ends them all.
using OracleRender = std::function<ReferenceResult(const ReferenceSettings& settings, const std::string& name)>;

// The truth as rays see it that meet only what layers of `view` hold, once for each number of layers that the
// experiment asks for, and the truth of fewer bounces, once for each number of those: the planes of the experiment that
// have halves in `truth`, with halves of their own; of fewer bounces only those that have light of bounces. `settings`
// are the truth's, down to the samples: what both have in common cancels in their difference. `place` names the view or
// path.
std::vector<PlaneImage> oracle_images(const Experiment& experiment, const ExperimentScene& entry,
                                      const std::string& place, const View& view, ReferenceSettings settings,
                                      const Frame& truth, const OracleRender& render);

}  // namespace plumb

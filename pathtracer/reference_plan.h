// What a reference has to estimate, from the planes that are wanted and what the scene holds.
#pragma once

#include <string>
#include <vector>

#include "pathtracer/accumulation.h"
#include "pathtracer/path_integrator.h"
#include "pathtracer/reference.h"
#include "pathtracer/traced_scene.h"

namespace plumb {

// The planes that are wanted, sorted by how they are found, and what has to be estimated for them.
struct RenderPlan {
    std::vector<StochasticPlane> stochastic;
    std::vector<std::string> gbuffer;
    int layers = 1;
    EstimationPlan estimation;
    // Each sample has a primary ray of its own: spread over the pixel, the lens or the time that the shutter is open.
    bool primary_rays_are_sampled = false;
};

// Throws ReferenceError for a plane that does not exist, and for settings that make no sense.
RenderPlan make_plan(const TracedScene& scene, const View& view, const ReferenceSettings& settings);

}  // namespace plumb

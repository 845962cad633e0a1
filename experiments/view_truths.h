// The truths of one view: the full one, and, for indirect light, the one limited to the radius that methods gather
// from.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/experiment_file.h"
#include "experiments/reference_cache.h"

namespace plumb {

struct Truth {
    std::string name;    // "full", "within 0.3 m"; empty for planes that have one truth only
    std::string plane;   // the plane that it is the truth of
    const Frame* frame;  // holds the plane and its halves
    int samples = 0;     // per pixel
};

// Whether a plane changes with Quantities::indirect_radius and is not a sum with light that does not.
bool has_limited_truth(const std::string& plane);

// What the full truth of a plane is called: nothing where it could be no other.
std::string full_truth_name(const std::string& plane);

// Whether a stage of the method is fed from the truth.
bool uses_truth(const Method& method);

// What the path tracer is asked for so that it is the truth of `planes` in `scene`.
ReferenceSettings full_truth_settings(const Experiment& experiment, const ExperimentScene& scene);
// Nothing where no plane has a limited truth or the radius is infinite.
std::optional<ReferenceSettings> limited_truth_settings(const Experiment& experiment, const ExperimentScene& scene);

struct ViewTruths {
    ReferenceResult full;
    std::optional<ReferenceResult> limited;
    float limit = 0.0f;  // metres

    // The truths of `plane`, the full one first.
    std::vector<Truth> of(const std::string& plane) const;
};

}  // namespace plumb

// Recorded rays traced again by bare calls of Embree, in each way that it has.
#pragma once

#include <span>
#include <vector>

#include "pathtracer/embree_api.h"
#include "pathtracer/ray_recorder.h"

namespace plumb {

using BareTrace = void (*)(RTCScene scene, const std::vector<RecordedRay>& rays, RayCoherence coherence);

// On all threads, in their order.
struct WayToTrace {
    const char* name;
    BareTrace nearest, any;
};

extern const WayToTrace singly, by_sixteen;
// Those and all others: packets of four and eight, and streams where this version of Embree has them.
std::span<const WayToTrace> ways_to_trace();

}  // namespace plumb

// Keeps the rays of a rendering, so that a benchmark can trace the very same ones again.
#pragma once

#include <mutex>
#include <vector>

#include <glm/glm.hpp>

#include "pathtracer/ray_batch.h"

namespace plumb {

struct RecordedRay {
    glm::vec3 origin, direction;
    float nearest, farthest;
};

class RayRecorder {
public:
    void add_nearest(const RayBatch& rays) { add(rays, nearest_); }
    void add_any(const RayBatch& rays) { add(rays, any_); }

    // Rays that asked for the nearest hit, and those that asked whether there is any; batch after batch.
    const std::vector<RecordedRay>& nearest() const { return nearest_; }
    const std::vector<RecordedRay>& any() const { return any_; }

private:
    void add(const RayBatch& rays, std::vector<RecordedRay>& list) {
        const std::scoped_lock lock(mutex_);
        for (int i = 0; i < rays.count; ++i) {
            list.push_back({rays.origin.get(i), rays.direction.get(i), rays.nearest[i], rays.farthest[i]});
        }
    }

    std::mutex mutex_;
    std::vector<RecordedRay> nearest_, any_;
};

}  // namespace plumb

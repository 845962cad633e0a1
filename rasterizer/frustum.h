// What a projection cannot see, told from bounding boxes, so that it is not drawn.
#pragma once

#include <array>

#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace plumb {

class Frustum {
public:
    // Planes of -w <= x <= w, -w <= y <= w, 0 <= z <= w.
    //   Source: Gribb and Hartmann 2001, "Fast Extraction of Viewing Frustum Planes from the World-View-Projection
    //   Matrix".
    explicit Frustum(const glm::mat4& clip_from_world) {
        const glm::mat4 rows = glm::transpose(clip_from_world);
        planes_ = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
                   rows[3] - rows[1], rows[2],           rows[3] - rows[2]};
    }

    // False only where the whole box lies outside one plane.
    bool may_see(const Bounds& box) const {
        for (const glm::vec4& plane : planes_) {
            const glm::vec3 farthest(plane.x > 0.0f ? box.upper.x : box.lower.x,
                                     plane.y > 0.0f ? box.upper.y : box.lower.y,
                                     plane.z > 0.0f ? box.upper.z : box.lower.z);
            if (glm::dot(plane, glm::vec4(farthest, 1.0f)) < 0.0f) return false;
        }
        return true;
    }

private:
    std::array<glm::vec4, 6> planes_;
};

}  // namespace plumb

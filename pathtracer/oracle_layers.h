// What the first layers of a view's G-buffer hold, as the oracle asks of every surface point that a ray meets.
//
// A point is contained where it projects into the view and lies on the surface that its pixel's ray met in one of the
// layers: within a pixel's width, at that depth, of the tangent plane there. That is all a screen-space method can know
// of it. With all layers, everything within the view's frustum is contained.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "pathtracer/surface_hit.h"
#include "scenes/camera.h"

namespace plumb {

class TracedScene;

class OracleLayers {
public:
    // `layers` of 0: all. The layers are those of exact_gbuffer.h, `minimum_separation` metres apart.
    OracleLayers(const TracedScene& scene, const View& view, int layers, float minimum_separation);

    bool contain(const glm::vec3& point) const;

private:
    // The tangent plane of a surface at a pixel's centre: dot(normal, p) = offset; a miss has no normal.
    struct Surface {
        glm::vec3 normal{0.0f};
        float offset = 0.0f;
    };

    View view_;
    int layers_;
    std::vector<Surface> surfaces_;  // pixel by pixel, layer after layer
};

}  // namespace plumb

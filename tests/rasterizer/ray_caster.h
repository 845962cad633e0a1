// An independent G-buffer: double precision, every triangle against every ray. For small scenes and images only.
#pragma once

#include <vector>

#include "frames/frame.h"
#include "scenes/camera.h"
#include "scenes/scene.h"

namespace plumb {

struct CastHit {
    bool hit = false;
    double depth = 0.0;     // metres along the camera's -Z
    double distance = 0.0;  // along the unit direction
    glm::dvec3 point{0.0}, normal{0.0}, albedo{0.0}, emission{0.0};
    int instance = -1;
};

class RayCaster {
public:
    explicit RayCaster(const Scene& scene);
    // The nearest surface whose distance lies between the bounds, alpha-masked holes passed.
    CastHit cast(const glm::dvec3& origin, const glm::dvec3& direction, double nearest, double farthest,
                 int ignored_instance = -1) const;
    bool occluded(const glm::dvec3& from, const glm::dvec3& to, int ignored_instance = -1) const;

    // The first two layers of a view, row by row.
    struct Layers {
        std::vector<CastHit> first, second;
    };
    Layers layers(const View& view, double minimum_separation) const;

private:
    struct Triangle {
        glm::dvec3 a, b, c;
        glm::dvec3 normals[3];
        glm::dvec2 uvs[3];
        bool face_normal;
        int instance, material;
        bool mirrored;
    };
    const Scene& scene_;
    std::vector<Triangle> triangles_;
};

// True where all neighbours within one pixel show the same instance, continuous depth and almost the same normal:
// elsewhere the rasterizer's sub-pixel grid (1/256 pixel) may show the neighbour's surface.
std::vector<bool> away_from_edges(const std::vector<CastHit>& layer, int width, int height);

}  // namespace plumb

#include "pathtracer/oracle_layers.h"

#include <cmath>
#include <cstddef>

#include "frames/parallel.h"
#include "pathtracer/exact_gbuffer.h"
#include "pathtracer/traced_scene.h"

namespace plumb {

OracleLayers::OracleLayers(const TracedScene& scene, const View& view, int layers, float minimum_separation)
    : view_(view), layers_(layers) {
    const std::size_t pixels = static_cast<std::size_t>(view.width()) * static_cast<std::size_t>(view.height());
    surfaces_.resize(pixels * static_cast<std::size_t>(layers));
    std::vector<SurfaceHit> hits;
    for (int layer = 0; layer < layers; ++layer) {
        hits = layer == 0 ? first_layer(scene, view) : next_layer(scene, view, hits, minimum_separation);
        parallel_for(view.height(), [&](int y) {
            for (int x = 0; x < view.width(); ++x) {
                const std::size_t pixel =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width()) + static_cast<std::size_t>(x);
                if (hits[pixel].missed()) continue;
                const Ray ray = view.pixel_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                const SurfacePoint point = scene.surface_point(hits[pixel], ray.direction);
                surfaces_[pixel * static_cast<std::size_t>(layers) + static_cast<std::size_t>(layer)] = {
                    point.geometric_normal, glm::dot(point.geometric_normal, point.position)};
            }
        });
    }
}

bool OracleLayers::contain(const glm::vec3& point) const {
    const glm::vec3 projected = view_.project(point);
    if (!(projected.z >= view_.camera().near_plane && projected.z <= view_.camera().far_plane)) return false;
    const float width = static_cast<float>(view_.width()), height = static_cast<float>(view_.height());
    if (!(projected.x >= 0.0f && projected.x < width && projected.y >= 0.0f && projected.y < height)) return false;
    if (layers_ == 0) return true;
    const std::size_t pixel = static_cast<std::size_t>(projected.y) * static_cast<std::size_t>(view_.width()) +
                              static_cast<std::size_t>(projected.x);
    const float tolerance = projected.z / view_.pixels_per_metre();
    for (int layer = 0; layer < layers_; ++layer) {
        const Surface& surface = surfaces_[pixel * static_cast<std::size_t>(layers_) + static_cast<std::size_t>(layer)];
        if (surface.normal == glm::vec3(0.0f)) return false;  // deeper layers are empty as well
        if (std::abs(glm::dot(surface.normal, point) - surface.offset) <= tolerance) return true;
    }
    return false;
}

}  // namespace plumb

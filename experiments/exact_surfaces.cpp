#include "experiments/exact_surfaces.h"

#include <algorithm>

#include "pathtracer/exact_gbuffer.h"

namespace plumb {
namespace {

double count_of(const std::vector<SurfaceHit>& layer) {
    return static_cast<double>(std::ranges::count_if(layer, [](const SurfaceHit& hit) { return !hit.missed(); }));
}

}  // namespace

double surfaces_per_pixel(const TracedScene& scene, const View& view) {
    std::vector<SurfaceHit> layer = first_layer(scene, view);
    const double pixels = count_of(layer);
    double surfaces = 0.0;
    for (double found = pixels; found > 0.0; found = count_of(layer)) {
        surfaces += found;
        layer = next_layer(scene, view, layer, 0.0f);
    }
    return surfaces / pixels;
}

double back_face_share(const TracedScene& scene, const View& view, float minimum_separation) {
    const std::vector<SurfaceHit> second = next_layer(scene, view, first_layer(scene, view), minimum_separation);
    double backs = 0.0;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            const SurfaceHit& hit = second[pixel_index(view, x, y)];
            if (hit.missed()) continue;
            const glm::vec3 direction =
                view.pixel_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f).direction;
            backs += glm::dot(scene.triangle(hit.instance, hit.triangle).scaled_normal(), direction) > 0.0f;
        }
    }
    return backs / count_of(second);
}

}  // namespace plumb

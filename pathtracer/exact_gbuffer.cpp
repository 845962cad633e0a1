#include "pathtracer/exact_gbuffer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "frames/parallel.h"
#include "pathtracer/reference_error.h"

namespace plumb {
namespace {

Ray centre_ray(const View& view, int x, int y) {
    return view.pixel_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
}

// The hits of all pixels; `nearest(index, scale)` is the distance from which on hits count, scale that of
// depth_per_distance.
template <typename Nearest>
std::vector<SurfaceHit> trace_layer(const TracedScene& scene, const View& view, const Nearest& nearest) {
    std::vector<SurfaceHit> hits(static_cast<std::size_t>(view.width()) * static_cast<std::size_t>(view.height()));
    parallel_for(view.height(), [&](int y) {
        for (int x = 0; x < view.width(); ++x) {
            const Ray ray = centre_ray(view, x, y);
            const float scale = depth_per_distance(view, ray.direction);
            const std::size_t pixel = pixel_index(view, x, y);
            const float from = nearest(pixel, scale);
            if (!(from < infinite_distance)) continue;
            hits[pixel] = scene.intersect(ray.origin, ray.direction, from, view.camera().far_plane / scale,
                                          RayCoherence::coherent);
        }
    });
    return hits;
}

// What the frame before this one saw: from where, and whether anything could have moved since.
struct PreviousFrame {
    const View& view;
    bool stood_still;  // no other view was given, and nothing moves

    // Pixels from the point's place in the previous view to its place now.
    glm::vec2 motion(const View& view_now, const glm::vec3& point_now, const glm::vec3& point_before) const {
        if (stood_still) return {0.0f, 0.0f};
        const glm::vec3 previous = view.project(point_before);
        if (!(previous.z > 0.0f)) return glm::vec2(infinite_distance);
        return glm::vec2(previous) - glm::vec2(view_now.project(point_now));
    }
    bool frames(const glm::vec3& point) const {
        const glm::vec3 at = view.project(point);
        return at.z > 0.0f && at.x >= 0.0f && at.x < static_cast<float>(view.width()) && at.y >= 0.0f &&
               at.y < static_cast<float>(view.height());
    }
};

constexpr float before = 0.0f;  // the begin of the scene's time span

// Where the surface point that a ray hits now was in the previous frame.
glm::vec3 position_before(const TracedScene& scene, const SurfaceHit& hit) {
    return scene.triangle(hit.instance, hit.triangle, before).point(hit.u, hit.v);
}

// Whether the previous frame saw the surface point that a ray hits now.
bool seen_before(const TracedScene& scene, const PreviousFrame& previous, const SurfaceHit& hit) {
    const glm::vec3 position = position_before(scene, hit);
    if (!previous.frames(position)) return false;
    const Camera& camera = previous.view.camera();
    const float depth = previous.view.project(position).z;
    if (depth < camera.near_plane || depth > camera.far_plane) return false;
    const glm::vec3 eye = camera.position();
    const glm::vec3 origin = scene.surface_point(hit, glm::normalize(position - eye), before).ray_origin;
    // Towards the eye as far as the near plane: what is nearer is not drawn.
    return scene
        .intersect(origin, eye - origin, positive_distance, 1.0f - camera.near_plane / depth, RayCoherence::coherent,
                   before)
        .missed();
}

// The same for what lies infinitely far away in `direction`.
bool background_seen_before(const TracedScene& scene, const PreviousFrame& previous, const glm::vec3& direction) {
    const Camera& camera = previous.view.camera();
    if (!previous.frames(camera.position() + direction)) return false;
    const float scale = depth_per_distance(previous.view, direction);
    return scene
        .intersect(camera.position(), direction, camera.near_plane / scale, camera.far_plane / scale,
                   RayCoherence::coherent, before)
        .missed();
}

struct PlaneName {
    std::string_view name;
    int channels;
};
constexpr std::array<PlaneName, 8> plane_names = {{{"depth", 1},
                                                   {"normal", 3},
                                                   {"albedo", 3},
                                                   {"position", 3},
                                                   {"motion", 2},
                                                   {"instance", 1},
                                                   {"emission", 3},
                                                   {"seen_before", 1}}};

std::string_view without_layer(std::string_view plane) {
    return plane.starts_with("layer") ? plane.substr(std::min(plane.find('.') + 1, plane.size())) : plane;
}

}  // namespace

float depth_per_distance(const View& view, const glm::vec3& direction) {
    return -glm::dot(glm::vec3(view.camera().world_from_camera[2]), direction);
}

std::vector<SurfaceHit> first_layer(const TracedScene& scene, const View& view) {
    return trace_layer(scene, view, [&](std::size_t, float scale) { return view.camera().near_plane / scale; });
}

std::vector<SurfaceHit> next_layer(const TracedScene& scene, const View& view, const std::vector<SurfaceHit>& layer,
                                   float minimum_separation) {
    return trace_layer(scene, view, [&](std::size_t pixel, float scale) {
        if (layer[pixel].missed()) return infinite_distance;
        return std::nextafter(layer[pixel].distance + minimum_separation / scale, infinite_distance);
    });
}

int layer_of(std::string_view plane) {
    if (!plane.starts_with("layer")) return 1;
    int layer = 0;
    const std::string_view digits =
        plane.substr(5, plane.find('.') == std::string_view::npos ? 0 : plane.find('.') - 5);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), layer);
    return error == std::errc() && end == digits.data() + digits.size() && layer >= 2 && layer <= 99 ? layer : 0;
}

bool is_gbuffer_plane(std::string_view plane) {
    const int layer = layer_of(plane);
    const std::string_view base = without_layer(plane);
    if (layer == 0 || (base == "emission" && layer == 1)) return false;
    return std::ranges::find(plane_names, base, &PlaneName::name) != plane_names.end();
}

void write_gbuffer_plane(const TracedScene& scene, const View& view, const View* previous_view,
                         const std::vector<SurfaceHit>& hits, const std::string& plane, Frame& frame) {
    const std::string_view base = without_layer(plane);
    const auto found = std::ranges::find(plane_names, base, &PlaneName::name);
    if (found == plane_names.end()) throw ReferenceError(fmt::format("plane '{}' is not one of a G-buffer", plane));
    Image& image = frame.set(plane, Image(view.width(), view.height(), found->channels));
    const bool first = layer_of(plane) == 1;
    const PreviousFrame previous{previous_view ? *previous_view : view, !previous_view && !scene.anything_moves()};
    parallel_for(view.height(), [&](int y) {
        for (int x = 0; x < view.width(); ++x) {
            const Ray ray = centre_ray(view, x, y);
            const SurfaceHit& hit = hits[pixel_index(view, x, y)];
            const bool missed = hit.missed();
            const SurfacePoint point = missed ? SurfacePoint{} : scene.surface_point(hit, ray.direction);
            glm::vec3 value(0.0f);
            if (base == "depth") {
                value.x = missed ? infinite_distance : hit.distance * depth_per_distance(view, ray.direction);
            } else if (base == "normal") {
                value = point.shading_normal;
            } else if (base == "albedo") {
                value = point.albedo;
            } else if (base == "position") {
                value = point.position;
            } else if (base == "emission") {
                value = missed && first ? scene.scene().environment_radiance(ray.direction) : point.emission;
            } else if (base == "instance") {
                value.x = missed ? -1.0f : static_cast<float>(hit.instance);
            } else if (base == "seen_before") {
                const bool seen =
                    missed ? background_seen_before(scene, previous, ray.direction) : seen_before(scene, previous, hit);
                value.x = seen ? 1.0f : 0.0f;
            } else if (missed) {
                value = glm::vec3(previous.motion(view, ray.origin + ray.direction,
                                                  previous.view.camera().position() + ray.direction),
                                  0.0f);
            } else {
                value = glm::vec3(previous.motion(view, point.position, position_before(scene, hit)), 0.0f);
            }
            for (int c = 0; c < found->channels; ++c) image.at(x, y, c) = value[c];
        }
    });
}

Image silhouettes(const Frame& gbuffer, const View& view, int layer) {
    const std::string prefix = layer == 1 ? "" : fmt::format("layer{}.", layer);
    const Image& depth = gbuffer.plane(prefix + "depth");
    const Image& normal = gbuffer.plane(prefix + "normal");
    const Image& position = gbuffer.plane(prefix + "position");
    const Image& instance = gbuffer.plane(prefix + "instance");
    const auto vector_at = [](const Image& image, int x, int y) {
        return glm::vec3(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2));
    };
    const float least_cosine = std::cos(0.2617994f);  // 15 degrees
    const auto differ = [&](int x, int y, int other_x, int other_y) {
        if (instance.at(x, y) != instance.at(other_x, other_y)) return true;
        if (instance.at(x, y) < 0.0f) return false;
        const glm::vec3 n = vector_at(normal, x, y);
        if (glm::dot(n, vector_at(normal, other_x, other_y)) < least_cosine) return true;
        const float step = glm::dot(n, vector_at(position, other_x, other_y) - vector_at(position, x, y));
        return std::abs(step) > depth.at(x, y) / view.pixels_per_metre();
    };
    Image mask(gbuffer.width(), gbuffer.height(), 1);
    for (int y = 0; y < mask.height(); ++y) {
        for (int x = 0; x < mask.width(); ++x) {
            bool edge = false;
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, mask.height() - 1); ++j) {
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, mask.width() - 1); ++i) {
                    edge = edge || differ(x, y, i, j);
                }
            }
            mask.at(x, y) = edge ? 1.0f : 0.0f;
        }
    }
    return mask;
}

}  // namespace plumb

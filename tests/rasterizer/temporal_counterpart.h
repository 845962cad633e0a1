// Reprojection, the temporal filter and temporal anti-aliasing on the CPU, in double precision, from the formulas of
// rasterizer/temporal_filter.h and rasterizer/temporal_antialias.h. Everything is taken from cameras, planes of frames
// and the scene's own motions, in world space; nothing from what the passes compute on the way.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "frames/frame.h"
#include "rasterizer/method.h"
#include "rasterizer/moment.h"

namespace plumb::counterpart {

// Continuous pixel coordinates (from the top left, with the view's offset) and depth of a world point.
inline glm::dvec3 seen_at(const View& view, const glm::dvec3& world) {
    const glm::dvec3 p(glm::inverse(glm::dmat4(view.camera().world_from_camera)) * glm::dvec4(world, 1.0));
    const double tan_half_height = std::tan(0.5 * view.camera().vertical_fov);
    const double pixels_per_metre = 0.5 * view.height() / tan_half_height;
    return {0.5 * view.width() + pixels_per_metre * p.x / -p.z - view.offset().x,
            0.5 * view.height() - pixels_per_metre * p.y / -p.z - view.offset().y, -p.z};
}

// The direction, not of unit length, through pixel coordinates: one metre along the camera's -Z.
inline glm::dvec3 ray_through(const View& view, double x, double y) {
    const double metres_per_pixel = std::tan(0.5 * view.camera().vertical_fov) / (0.5 * view.height());
    const glm::dvec3 in_camera(metres_per_pixel * (x + view.offset().x - 0.5 * view.width()),
                               metres_per_pixel * (0.5 * view.height() - y - view.offset().y), -1.0);
    return glm::dmat3(view.camera().world_from_camera) * in_camera;
}

inline glm::dvec3 eye_of(const View& view) { return glm::dvec3(view.camera().position()); }

// One frame, with the view that it was rendered with, and how each instance that moves has moved since the frame
// before, in their order in the scene: matrices that take world space of now to world space of then.
struct RenderedFrame {
    View view;
    Frame planes;
    std::vector<glm::dmat4> before_from_now = {};
};

// Of the instances of `scene` between two moments.
inline std::vector<glm::dmat4> motions_between(const Scene& scene, const Moment& now, const Moment& before) {
    std::vector<glm::dmat4> motions;
    for (const Instance& instance : scene.instances) {
        if (instance.moves())
            motions.push_back(glm::dmat4(before.pose(instance)) * glm::inverse(glm::dmat4(now.pose(instance))));
    }
    return motions;
}

inline glm::dvec3 vector_of(const Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

// The surface point of a pixel, now and, with what the G-buffer says of its instance, in the frame before.
struct SurfacePoint {
    glm::dvec3 now, before;  // world space
    glm::dmat4 motion;       // of its instance
};

// None where nothing is seen. `prefix` is that of the layer's planes.
inline std::optional<SurfacePoint> surface_point(const RenderedFrame& frame, int x, int y,
                                                 const std::string& prefix = "") {
    const double depth = frame.planes.plane(prefix + "depth").at(x, y);
    if (std::isinf(depth)) return {};
    SurfacePoint point;
    point.now = eye_of(frame.view) + depth * ray_through(frame.view, x + 0.5, y + 0.5);
    point.motion = glm::dmat4(1.0);
    if (frame.planes.has(prefix + "moving_instance")) {
        const auto number = static_cast<std::size_t>(frame.planes.plane(prefix + "moving_instance").at(x, y));
        if (number > 0) point.motion = frame.before_from_now.at(number - 1);
    }
    point.before = glm::dvec3(point.motion * glm::dvec4(point.now, 1.0));
    return point;
}

// Where the normal of a surface point was pointing in the frame before: turned as its instance has turned.
inline glm::dvec3 normal_before(const SurfacePoint& point, const glm::dvec3& normal) {
    return glm::normalize(glm::transpose(glm::inverse(glm::dmat3(point.motion))) * normal);
}

struct Accumulated {
    double value = 0.0, weight = 0.0;
};

// What is left of the weight at a distance in metres.
inline double acceptance(const TemporalFilterSettings& settings, double distance) {
    const double range = settings.reject_to - settings.reject_from, beyond = distance - settings.reject_from;
    const double t = range > 0.0 ? std::clamp(beyond / range, 0.0, 1.0) : beyond > 0.0 ? 1.0 : 0.0;
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

// By how much float arithmetic may be off.
struct Doubt {
    glm::dvec2 place{0.0};   // pixels, of where a point was
    glm::dvec3 normal{0.0};  // of its normal
    double depth = 0.0;      // of a distance, as a share of the depth
};

// What the filter makes of `this_frame` at a pixel, `history` being its result of the frame before; both of `layer`.
inline Accumulated accumulate(const RenderedFrame& now, const RenderedFrame& before, const Image& this_frame,
                              const Image& history, const TemporalFilterSettings& settings, int x, int y, int layer = 0,
                              const Doubt& doubt = {}) {
    Accumulated result{this_frame.at(x, y), 0.0};
    const std::array<std::string, 2> prefixes{"", "layer2."};
    const std::string& prefix = prefixes.at(static_cast<std::size_t>(layer));
    const std::optional<SurfacePoint> point = surface_point(now, x, y, prefix);
    if (!point) return result;
    const glm::dvec3 place = seen_at(before.view, point->before) + glm::dvec3(doubt.place, 0.0);
    if (place.z <= 0.0) return result;
    const glm::dvec3 normal =
        glm::normalize(normal_before(*point, vector_of(now.planes.plane(prefix + "normal"), x, y)) + doubt.normal);
    const glm::dvec3 from_eye = point->before - eye_of(before.view);
    const auto nearest_to = [&](const glm::dvec3& ray, double expected, double column, double row) {
        double distance = std::numeric_limits<double>::infinity();
        for (const std::string& shown : prefixes) {
            // Of its own layer, or of both.
            if (shown != prefix && settings.layers == 1) continue;
            const double depth =
                before.planes.plane(shown + "depth").at(static_cast<int>(column), static_cast<int>(row));
            distance = std::min(distance, std::abs(depth - expected) * glm::length(ray));
        }
        return distance;
    };
    double from_point = 0.0;
    if (settings.rejection == HistoryRejection::mara2016) {
        const double column = std::floor(place.x), row = std::floor(place.y);
        if (column < 0 || row < 0 || column >= this_frame.width() || row >= this_frame.height()) return result;
        from_point = nearest_to(ray_through(before.view, place.x, place.y), place.z * (1.0 + doubt.depth), column, row);
    }
    const double left = std::floor(place.x - 0.5), top = std::floor(place.y - 0.5);
    for (const double column : {left, left + 1.0}) {
        for (const double row : {top, top + 1.0}) {
            if (column < 0 || row < 0 || column >= this_frame.width() || row >= this_frame.height()) continue;
            const double share = (1.0 - std::abs(place.x - 0.5 - column)) * (1.0 - std::abs(place.y - 0.5 - row));
            const glm::dvec3 ray = ray_through(before.view, column + 0.5, row + 0.5);
            double expected = glm::dot(normal, from_eye) / glm::dot(normal, ray) * (1.0 + doubt.depth);
            if (!(expected > 0.5 * place.z && expected < 2.0 * place.z)) expected = place.z;
            const double distance =
                settings.rejection == HistoryRejection::mara2016 ? from_point : nearest_to(ray, expected, column, row);
            const double weight = settings.alpha * share * acceptance(settings, distance);
            if (weight == 0.0) continue;
            result.value +=
                weight * (history.at(static_cast<int>(column), static_cast<int>(row)) - this_frame.at(x, y));
            result.weight += weight;
        }
    }
    return result;
}

// The least and the most that rounding may make of it.
struct AccumulatedRange {
    Accumulated least, most;
    bool holds(double value, double weight, double rounding) const {
        return value >= least.value - rounding && value <= most.value + rounding && weight >= least.weight - rounding &&
               weight <= most.weight + rounding;
    }
};

inline AccumulatedRange accumulated_range(const RenderedFrame& now, const RenderedFrame& before,
                                          const Image& this_frame, const Image& history,
                                          const TemporalFilterSettings& settings, int x, int y, int layer = 0) {
    const Accumulated exact = accumulate(now, before, this_frame, history, settings, x, y, layer);
    AccumulatedRange range{exact, exact};
    const std::string prefix = layer == 0 ? "" : "layer2.";
    if (!surface_point(now, x, y, prefix)) return range;
    // Positions some metres away are good to 1.5e-6 m in float, and a metre away there are 100 to 200 pixels to a
    // metre.
    constexpr double of_place = 3e-4, of_depth = 1e-6;
    constexpr double of_normal = 1e-6;  // read from the same bits, and turned in float
    for (const double dx : {-of_place, of_place}) {
        for (const double dy : {-of_place, of_place}) {
            for (int axis = 0; axis < 6; ++axis) {
                Doubt doubt{.place = {dx, dy}, .depth = axis < 3 ? of_depth : -of_depth};
                doubt.normal[axis % 3] = axis < 3 ? of_normal : -of_normal;
                const Accumulated other = accumulate(now, before, this_frame, history, settings, x, y, layer, doubt);
                range.least.value = std::min(range.least.value, other.value);
                range.least.weight = std::min(range.least.weight, other.weight);
                range.most.value = std::max(range.most.value, other.value);
                range.most.weight = std::max(range.most.weight, other.weight);
            }
        }
    }
    return range;
}

// An image that temporal anti-aliasing has resolved, and over how many frames each pixel is averaged.
struct Resolved {
    Image colour, frames;
};

// Weight of a pixel `distance` from where is looked: the triangle, or Keys' cubic of 1981 with a = -1/2, which is what
// Catmull and Rom's spline amounts to.
inline double lookup_weight(HistoryLookup lookup, double distance) {
    const double d = std::abs(distance);
    if (lookup == HistoryLookup::bilinear) return std::max(0.0, 1.0 - d);
    if (d < 1.0) return 1.5 * d * d * d - 2.5 * d * d + 1.0;
    return d < 2.0 ? -0.5 * d * d * d + 2.5 * d * d - 4.0 * d + 2.0 : 0.0;
}

inline glm::dvec3 looked_up(HistoryLookup lookup, const Image& image, const glm::dvec2& place) {
    const double left = std::floor(place.x - 0.5), top = std::floor(place.y - 0.5);
    glm::dvec3 sum(0.0);
    for (double column = left - 1.0; column <= left + 2.0; ++column) {
        for (double row = top - 1.0; row <= top + 2.0; ++row) {
            const double weight =
                lookup_weight(lookup, place.x - 0.5 - column) * lookup_weight(lookup, place.y - 0.5 - row);
            const int x = static_cast<int>(std::clamp(column, 0.0, image.width() - 1.0));
            const int y = static_cast<int>(std::clamp(row, 0.0, image.height() - 1.0));
            for (int c = 0; c < image.channels(); ++c) sum[c] += weight * image.at(x, y, c);
        }
    }
    return glm::max(sum, glm::dvec3(0.0));
}

// Resolves a frame; `before` and `history` are null on the first.
inline Resolved resolve(const RenderedFrame& now, const RenderedFrame* before, const Resolved* history,
                        const AntialiasSettings& settings, const glm::dvec2& doubt_of_place = glm::dvec2(0.0)) {
    const Image &aliased = now.planes.plane("total.aliased"), &depth = now.planes.plane("depth");
    const int width = aliased.width(), height = aliased.height();
    Resolved result{aliased, Image(width, height, 1, 1.0f)};
    if (!before) return result;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            glm::ivec2 surface(x, y);
            const glm::dvec3 colour = vector_of(aliased, x, y);
            glm::dvec3 least = colour, greatest = colour;
            for (int dy = 1; dy >= -1; --dy) {
                for (int dx = -1; dx <= 1; ++dx) {
                    const glm::ivec2 p =
                        glm::clamp(glm::ivec2(x + dx, y + dy), glm::ivec2(0), glm::ivec2(width, height) - 1);
                    least = glm::min(least, vector_of(aliased, p.x, p.y));
                    greatest = glm::max(greatest, vector_of(aliased, p.x, p.y));
                    if (settings.dilate && depth.at(p.x, p.y) < depth.at(surface.x, surface.y)) surface = p;
                }
            }
            glm::dvec2 place = glm::dvec2(x, y) + 0.5;
            if (settings.reprojection) {
                const std::optional<SurfacePoint> point = surface_point(now, surface.x, surface.y);
                // The background is seen in the same direction; a kilometre and more beyond the eye stands for it.
                const glm::dvec3 direction = ray_through(now.view, surface.x + 0.5, surface.y + 0.5);
                const glm::dvec3 world = point ? point->before : eye_of(before->view) + 1e6 * direction;
                const glm::dvec3 seen = seen_at(before->view, world);
                if (seen.z <= 0.0) continue;
                const glm::dvec2 then = glm::dvec2(seen) + glm::dvec2(before->view.offset());
                const glm::dvec2 here = glm::dvec2(surface) + 0.5 + glm::dvec2(now.view.offset());
                place += then - here + doubt_of_place;
            }
            if (place.x < 0.0 || place.y < 0.0 || place.x > width || place.y > height) continue;
            glm::dvec3 kept = looked_up(settings.lookup, history->colour, place);
            if (settings.clamp) kept = glm::clamp(kept, least, greatest);
            const double frames = looked_up(settings.lookup, history->frames, place).x + 1.0;
            const double share = std::max(1.0 - static_cast<double>(settings.alpha), 1.0 / frames);
            for (int c = 0; c < 3; ++c)
                result.colour.at(x, y, c) = static_cast<float>(kept[c] + share * (colour[c] - kept[c]));
            result.frames.at(x, y) = static_cast<float>(frames);
        }
    }
    return result;
}

// The least and the most that rounding may make of it, and the exact result.
struct ResolvedRange {
    Resolved exact;
    Image least, most;
};

inline ResolvedRange resolved_range(const RenderedFrame& now, const RenderedFrame* before, const Resolved* history,
                                    const AntialiasSettings& settings) {
    ResolvedRange range{resolve(now, before, history, settings), {}, {}};
    range.least = range.most = range.exact.colour;
    constexpr double of_place = 3e-4;  // as in accumulated_range()
    for (const glm::dvec2& doubt : {glm::dvec2(-of_place, -of_place), glm::dvec2(-of_place, of_place),
                                    glm::dvec2(of_place, -of_place), glm::dvec2(of_place, of_place)}) {
        const Resolved other = resolve(now, before, history, settings, doubt);
        for (std::size_t i = 0; i < other.colour.values().size(); ++i) {
            range.least.values()[i] = std::min(range.least.values()[i], other.colour.values()[i]);
            range.most.values()[i] = std::max(range.most.values()[i], other.colour.values()[i]);
        }
    }
    return range;
}

}  // namespace plumb::counterpart

#include "metrics/surface_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "frames/image_error.h"

namespace plumb {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// To the position of a pixel that may lie outside or show nothing: then infinite.
double distance_to(const Image& position, std::span<const float> from, int x, int y) {
    if (x < 0 || y < 0 || x >= position.width() || y >= position.height()) return infinity;
    const auto there = position.pixel(x, y);
    const double distance =
        std::hypot(double{there[0]} - from[0], double{there[1]} - from[1], double{there[2]} - from[2]);
    return std::isnan(distance) ? infinity : distance;
}

}  // namespace

BilinearPlace BilinearPlace::at(double x, double y) {
    const double x0 = std::floor(x), y0 = std::floor(y);
    const double fx = x - x0, fy = y - y0;
    const int ix = static_cast<int>(x0), iy = static_cast<int>(y0);
    return {{{{ix, iy, (1 - fx) * (1 - fy)},
              {ix + 1, iy, fx * (1 - fy)},
              {ix, iy + 1, (1 - fx) * fy},
              {ix + 1, iy + 1, fx * fy}}}};
}

double BilinearPlace::look_up(const Image& image, int channel) const {
    double sum = 0;
    for (const Tap& tap : taps) {
        if (tap.weight > 0.0) sum += tap.weight * image.at(tap.x, tap.y, channel);
    }
    return sum;
}

bool BilinearPlace::inside(int width, int height) const {
    return std::ranges::all_of(taps, [&](const Tap& tap) {
        return tap.weight == 0.0 || (tap.x >= 0 && tap.y >= 0 && tap.x < width && tap.y < height);
    });
}

bool shows_surface(const BilinearPlace& place, const Image& positions, const std::array<double, 3>& position,
                   double radius) {
    if (!place.inside(positions.width(), positions.height())) return false;
    return std::ranges::all_of(place.taps, [&](const BilinearPlace::Tap& tap) {
        if (tap.weight == 0.0) return true;
        const auto there = positions.pixel(tap.x, tap.y);
        // Written so that a NaN is not the same surface.
        return std::hypot(there[0] - position[0], there[1] - position[1], there[2] - position[2]) <= radius;
    });
}

double same_surface_radius(const Image& position, double depth, int x, int y, double tolerance) {
    const auto own = position.pixel(x, y);
    // Of a pixel at an edge one of two neighbours still shows its surface.
    const double along_row = std::min(distance_to(position, own, x - 1, y), distance_to(position, own, x + 1, y));
    const double along_column = std::min(distance_to(position, own, x, y - 1), distance_to(position, own, x, y + 1));
    const double step = std::max(along_row, along_column);
    if (std::isinf(step)) return tolerance * depth;
    // At things one pixel wide both neighbours show what lies behind, which is no step along a surface.
    constexpr double widest = 5.0;
    return tolerance * depth * std::clamp(2.0 * step / (tolerance * depth), 1.0, widest);
}

std::optional<BilinearPlace> place_before(const Image& motion, const Image& depth, const Image& position,
                                          const Image& position_before, int x, int y, double tolerance) {
    const double before_x = x + double{motion.at(x, y, 0)}, before_y = y + double{motion.at(x, y, 1)};
    // Also false for motion that is no number, before floor() meets it.
    const bool inside =
        before_x > -1.0 && before_x < position_before.width() && before_y > -1.0 && before_y < position_before.height();
    const double distance = depth.at(x, y);
    if (!inside || !is_surface(distance)) return std::nullopt;
    const BilinearPlace place = BilinearPlace::at(before_x, before_y);
    const auto own = position.pixel(x, y);
    const double radius = same_surface_radius(position, distance, x, y, tolerance);
    if (!shows_surface(place, position_before, {own[0], own[1], own[2]}, radius)) return std::nullopt;
    return place;
}

void require_motion(const Frame& frame, const char* what) {
    for (const auto& [plane, channels] :
         {std::pair<std::string_view, int>{"motion", 2}, {"depth", 1}, {"position", 3}}) {
        const Image& image = frame.plane(plane);
        if (image.channels() != channels) {
            throw ImageError(fmt::format("plane '{}' of {} has {} channels; to follow surfaces over frames it needs {}",
                                         plane, what, image.channels(), channels));
        }
    }
}

}  // namespace plumb

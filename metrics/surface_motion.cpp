#include "metrics/surface_motion.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "frames/image_error.h"

namespace plumb {

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

std::optional<BilinearPlace> place_before(const Image& motion, const Image& depth, const Image& position,
                                          const Image& position_before, int x, int y, double tolerance) {
    const double before_x = x + double{motion.at(x, y, 0)}, before_y = y + double{motion.at(x, y, 1)};
    // Also false for motion that is no number, before floor() meets it.
    const bool inside =
        before_x > -1.0 && before_x < position_before.width() && before_y > -1.0 && before_y < position_before.height();
    const double distance = depth.at(x, y);
    if (!inside || !std::isfinite(distance) || !(distance > 0.0)) return std::nullopt;
    const BilinearPlace place = BilinearPlace::at(before_x, before_y);
    const auto own = position.pixel(x, y);
    if (!shows_surface(place, position_before, {own[0], own[1], own[2]}, tolerance * distance)) return std::nullopt;
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

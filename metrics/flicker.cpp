#include "metrics/flicker.h"

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "frames/image_error.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

struct Tap {
    int x, y;
    double weight;
};

// The pixels that a bilinear look-up at (x, y) reads, in units of pixel indices; weight 0 for those it does not need.
std::array<Tap, 4> bilinear_taps(double x, double y) {
    const double x0 = std::floor(x), y0 = std::floor(y);
    const double fx = x - x0, fy = y - y0;
    const int ix = static_cast<int>(x0), iy = static_cast<int>(y0);
    return {{{ix, iy, (1 - fx) * (1 - fy)},
             {ix + 1, iy, fx * (1 - fy)},
             {ix, iy + 1, (1 - fx) * fy},
             {ix + 1, iy + 1, fx * fy}}};
}

double distance(std::span<const float> a, std::span<const float> b) {
    return std::hypot(double{a[0]} - b[0], double{a[1]} - b[1], double{a[2]} - b[2]);
}

bool same_surface(const std::array<Tap, 4>& taps, const Image& position_before, std::span<const float> position,
                  double radius) {
    for (const Tap& tap : taps) {
        if (tap.weight == 0.0) continue;
        if (tap.x < 0 || tap.y < 0 || tap.x >= position_before.width() || tap.y >= position_before.height())
            return false;
        // Written so that a NaN is not the same surface.
        if (!(distance(position_before.pixel(tap.x, tap.y), position) <= radius)) return false;
    }
    return true;
}

double look_up(const Image& image, const std::array<Tap, 4>& taps, int channel) {
    double sum = 0;
    for (const Tap& tap : taps) {
        if (tap.weight > 0.0) sum += tap.weight * image.at(tap.x, tap.y, channel);
    }
    return sum;
}

void require_channels(const Image& image, int channels, std::string_view plane) {
    if (image.channels() != channels) {
        throw ImageError(fmt::format("plane '{}' of the truth has {} channels; flicker needs {}", plane,
                                     image.channels(), channels));
    }
}

// Sums of squared changes over one pixel's channels.
struct Changes {
    double error = 0, method = 0, truth = 0;
};

}  // namespace

Flicker flicker(const Frame& method_before, const Frame& truth_before, const Frame& method_now, const Frame& truth_now,
                std::string_view plane, const FlickerSettings& settings) {
    const Image &method = method_now.plane(plane), &method_past = method_before.plane(plane);
    const Image &truth = truth_now.plane(plane), &truth_past = truth_before.plane(plane);
    const Image &motion = truth_now.plane("motion"), &depth = truth_now.plane("depth");
    const Image &position = truth_now.plane("position"), &position_past = truth_before.plane("position");
    for (const Image* image : {&method_past, &truth_past, &method}) {
        require_same_shape(*image, truth, fmt::format("plane '{}' of two frames", plane));
    }
    require_same_shape(position_past, position, "plane 'position' of two frames");
    require_channels(motion, 2, "motion");
    require_channels(depth, 1, "depth");
    require_channels(position, 3, "position");

    Flicker result;
    Changes sums;
    for (int y = 0; y < truth.height(); ++y) {
        for (int x = 0; x < truth.width(); ++x) {
            const double before_x = x + double{motion.at(x, y, 0)}, before_y = y + double{motion.at(x, y, 1)};
            const bool inside =
                before_x > -1.0 && before_x < truth.width() && before_y > -1.0 && before_y < truth.height();
            const bool surface = std::isfinite(depth.at(x, y)) && depth.at(x, y) > 0.0f;
            const auto taps = inside ? bilinear_taps(before_x, before_y) : std::array<Tap, 4>{};
            if (!inside || !surface ||
                !same_surface(taps, position_past, position.pixel(x, y), settings.tolerance * depth.at(x, y))) {
                ++result.not_visible;
                continue;
            }
            Changes changes;
            for (int c = 0; c < truth.channels(); ++c) {
                const double of_method = method.at(x, y, c) - look_up(method_past, taps, c);
                const double of_truth = truth.at(x, y, c) - look_up(truth_past, taps, c);
                changes.error += (of_method - of_truth) * (of_method - of_truth);
                changes.method += of_method * of_method;
                changes.truth += of_truth * of_truth;
            }
            if (!std::isfinite(changes.error)) {
                ++result.non_finite;
                continue;
            }
            ++result.pixels;
            sums.error += changes.error;
            sums.method += changes.method;
            sums.truth += changes.truth;
        }
    }
    const double count = static_cast<double>(result.pixels) * truth.channels();
    const auto rms = [count](double sum) {
        return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
    };
    result.rms = rms(sums.error);
    result.method_warping = rms(sums.method);
    result.truth_warping = rms(sums.truth);
    return result;
}

}  // namespace plumb

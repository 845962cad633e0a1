#include "metrics/path_lag.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "frames/image_error.h"
#include "metrics/referenced_error.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

// Pixels that move by less are still: rounding of motion vectors is below a thousandth of a pixel.
constexpr double still_motion = 0.01;

void accumulate(Image& sum, const Image& image) {
    for (std::size_t i = 0; i < sum.values().size(); ++i) sum.values()[i] += image.values()[i];
}

// Sums over a block's pixels and channels.
struct Products {
    double truth_course = 0, truth_change = 0;    // <sum_t (T_t - T_0), D>, <D, D>
    double method_course = 0, method_change = 0;  // <sum_t (M_t - M_0), D>, <M_settled - M_0, D>
};

double lag_of(const std::vector<Products>& blocks, const std::vector<double>& counts) {
    Products all;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        all.truth_course += counts[b] * blocks[b].truth_course, all.truth_change += counts[b] * blocks[b].truth_change;
        all.method_course += counts[b] * blocks[b].method_course;
        all.method_change += counts[b] * blocks[b].method_change;
    }
    return all.truth_course / all.truth_change - all.method_course / all.method_change;
}

}  // namespace

void PathLag::Course::add(const Image& image) {
    if (first.empty()) {
        first = image;
        sum = Image(image.width(), image.height(), image.channels());
    } else {
        require_same_shape(first, image, "images of two frames");
        accumulate(sum, image);
    }
    last = image;
}

PathLag::PathLag(std::string plane, const PathLagSettings& settings) : plane_(std::move(plane)), settings_(settings) {}

void PathLag::add(const Frame& method, const Frame& truth) {
    require_motion(truth, "the truth");
    const bool halves = has_halves(truth, plane_);
    const Image &image = method.plane(plane_), &a = truth.plane(halves ? half_a_of(plane_) : plane_),
                &b = truth.plane(halves ? half_b_of(plane_) : plane_);
    require_same_shape(image, a, "the plane of method and truth");
    method_.add(image), truth_a_.add(a), truth_b_.add(b);

    const Image &motion = truth.plane("motion"), &depth = truth.plane("depth"), &position = truth.plane("position");
    const bool is_first = frames_++ == 0;
    if (is_first) {
        first_position_ = position;
        still_ = Image(image.width(), image.height(), 1, 1.0f);
    }
    require_same_shape(first_position_, position, "plane 'position' of two frames");
    for (int y = 0; y < still_.height(); ++y) {
        for (int x = 0; x < still_.width(); ++x) {
            const auto at = position.pixel(x, y);
            const double z = depth.at(x, y);
            // What moved to its first place is there from then on.
            const bool stands = is_first || std::hypot(motion.at(x, y, 0), motion.at(x, y, 1)) <= still_motion;
            const bool same =
                is_surface(z) && shows_surface(BilinearPlace::at(x, y), first_position_, {at[0], at[1], at[2]},
                                               same_surface_radius(position, z, x, y, settings_.tolerance));
            if (!stands || !same) still_.at(x, y) = 0.0f;
        }
    }
}

void PathLag::hold(const Image& sum, const Image& settled, int frames) {
    if (frames_ == 0) throw ImageError("a path of no frames cannot be held; add its frames first");
    require_same_shape(method_.first, sum, "held pictures and those of the path");
    require_same_shape(method_.first, settled, "held pictures and those of the path");
    held_sum_ = sum, settled_ = settled, held_frames_ = frames;
}

Estimate PathLag::result() const {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (held_frames_ == 0 || frames_ < 2) return {none, none, none};
    const int width = still_.width(), height = still_.height();
    const BlockGrid grid(width, height, settings_.bootstrap.block_size, &still_);
    std::vector<Products> blocks(grid.count());
    std::vector<BlockSum> changes(grid.count());
    const double later = frames_ - 1 + held_frames_;  // frames after the first
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (still_.at(x, y) == 0.0f) continue;
            Products pixel;
            for (int c = 0; c < method_.first.channels(); ++c) {
                const auto change = [&](const Course& truth) {
                    return double{truth.last.at(x, y, c)} - truth.first.at(x, y, c);
                };
                // Held, the truth stays as it is.
                const auto course = [&](const Course& truth) {
                    return truth.sum.at(x, y, c) + held_frames_ * double{truth.last.at(x, y, c)} -
                           later * truth.first.at(x, y, c);
                };
                const double a = change(truth_a_), b = change(truth_b_), first = method_.first.at(x, y, c);
                pixel.truth_course += 0.5 * (course(truth_a_) * b + course(truth_b_) * a);
                pixel.truth_change += a * b;
                const double shown = double{method_.sum.at(x, y, c)} + held_sum_.at(x, y, c) - later * first;
                pixel.method_course += shown * 0.5 * (a + b);
                pixel.method_change += (settled_.at(x, y, c) - first) * 0.5 * (a + b);
            }
            if (!std::isfinite(pixel.truth_course + pixel.method_course + pixel.method_change)) continue;
            const std::size_t block = grid.block_of(x, y);
            Products& sums = blocks[block];
            sums.truth_course += pixel.truth_course, sums.truth_change += pixel.truth_change;
            sums.method_course += pixel.method_course, sums.method_change += pixel.method_change;
            changes[block].add(pixel.truth_change);
        }
    }
    if (!(bootstrap_mean(changes, settings_.bootstrap).lower > 0.0)) return {none, none, none};
    return bootstrap_of_draws(
        blocks.size(), [&](const std::vector<double>& counts) { return lag_of(blocks, counts); }, settings_.bootstrap);
}

}  // namespace plumb

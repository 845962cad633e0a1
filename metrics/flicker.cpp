#include "metrics/flicker.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "frames/image_error.h"
#include "frames/parallel.h"
#include "metrics/error_image.h"
#include "metrics/referenced_error.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

// Sums over one pixel's channels.
struct Changes {
    double error = 0, method = 0, truth = 0, noise = 0;
};

Changes changes_at(const FrameErrors& before, const FrameErrors& now, const BilinearPlace& place, int x, int y) {
    Changes changes;
    const bool paired = !now.second_half.empty() && !before.second_half.empty();
    for (int c = 0; c < now.method.channels(); ++c) {
        const double method = now.method.at(x, y, c) - place.look_up(before.method, c);
        const double other = paired ? now.second_half.at(x, y, c) - place.look_up(before.second_half, c) : method;
        const double a = now.error_a.at(x, y, c) - place.look_up(before.error_a, c);
        const double b = now.error_b.at(x, y, c) - place.look_up(before.error_b, c);
        changes.error += a * b;
        changes.method += method * other;
        changes.truth += (method - a) * (other - b);
        changes.noise += 0.25 * (a - b) * (a - b);
    }
    return changes;
}

void require_motion_planes(const FrameErrors& frame, int width, int height) {
    if (frame.motion.width() != width || frame.depth.width() != width || frame.position.width() != width ||
        frame.motion.height() != height || frame.depth.height() != height || frame.position.height() != height) {
        throw ImageError(fmt::format("planes motion, depth and position of the truth must be {}x{} as the images are",
                                     width, height));
    }
}

}  // namespace

FrameErrors FrameErrors::of(const Frame& method, const Frame& truth, std::string_view plane) {
    FrameErrors frame;
    const std::string name(plane), a = half_a_of(plane), b = half_b_of(plane);
    const bool halves = has_halves(truth, plane), paired = halves && has_halves(method, plane);
    frame.method = method.plane(paired ? a : name);
    if (paired) frame.second_half = method.plane(b);
    const auto error = [&](const Image& image, const std::string& of_truth) {
        require_same_shape(image, truth.plane(of_truth), fmt::format("plane '{}' of method and truth", of_truth));
        return signed_difference(image, truth.plane(of_truth));
    };
    frame.error_a = error(frame.method, halves ? a : name);
    frame.error_b = error(paired ? frame.second_half : frame.method, halves ? b : name);
    for (const auto& [image, of_truth] :
         {std::pair{&frame.motion, "motion"}, {&frame.depth, "depth"}, {&frame.position, "position"}}) {
        if (truth.has(of_truth)) *image = truth.plane(of_truth);
    }
    return frame;
}

ChangeSums sum_changes(const FrameErrors& before, const FrameErrors& now, const BlockGrid& grid, double tolerance,
                       const Image* mask) {
    require_same_shape(before.method, now.method, "images of two frames");
    const int width = now.method.width(), height = now.method.height();
    require_motion_planes(now, width, height);
    require_same_shape(before.position, now.position, "plane 'position' of two frames");
    if (mask) require_mask_fits(*mask, now.method);

    ChangeSums sums;
    for (auto* blocks : {&sums.error, &sums.method, &sums.truth, &sums.noise}) blocks->resize(grid.count());
    struct Counts {
        std::size_t pixels = 0, not_visible = 0, non_finite = 0;
    };
    std::vector<Counts> counts(static_cast<std::size_t>(grid.rows()));
    // A row of blocks belongs to one thread: the same bits whatever the number of threads.
    parallel_for(grid.rows(), [&](int row) {
        Counts& count = counts[static_cast<std::size_t>(row)];
        const int end = std::min(height, (row + 1) * grid.block_size());
        for (int y = row * grid.block_size(); y < end; ++y) {
            for (int x = 0; x < width; ++x) {
                if (!pixel_counts(mask, x, y)) continue;
                const auto place = place_before(now.motion, now.depth, now.position, before.position, x, y, tolerance);
                if (!place) {
                    ++count.not_visible;
                    continue;
                }
                const Changes changes = changes_at(before, now, *place, x, y);
                if (!std::isfinite(changes.error) || !std::isfinite(changes.truth)) {
                    ++count.non_finite;
                    continue;
                }
                ++count.pixels;
                const std::size_t block = grid.block_of(x, y);
                const auto channels = static_cast<std::size_t>(now.method.channels());
                sums.error[block].add(changes.error, channels);
                sums.method[block].add(changes.method, channels);
                sums.truth[block].add(changes.truth, channels);
                sums.noise[block].add(changes.noise, channels);
            }
        }
    });
    for (const Counts& count : counts) {
        sums.pixels += count.pixels;
        sums.not_visible += count.not_visible;
        sums.non_finite += count.non_finite;
    }
    return sums;
}

Flicker flicker_of(const ChangeSums& sums, const BootstrapSettings& settings) {
    Flicker result;
    const Estimate rms = bootstrap_mean(sums.error, settings).root();
    result.rms = rms.value, result.rms_lower = rms.lower, result.rms_upper = rms.upper;
    const auto root_mean = [](const std::vector<BlockSum>& blocks) {
        return Estimate{mean_of(blocks), 0.0, 0.0}.root().value;
    };
    result.method_warping = root_mean(sums.method);
    result.truth_warping = root_mean(sums.truth);
    result.noise = root_mean(sums.noise);
    result.pixels = sums.pixels, result.not_visible = sums.not_visible, result.non_finite = sums.non_finite;
    return result;
}

Flicker flicker(const Frame& method_before, const Frame& truth_before, const Frame& method_now, const Frame& truth_now,
                std::string_view plane, const FlickerSettings& settings) {
    require_motion(truth_now, "the truth");
    truth_before.plane("position");  // throws where it is missing
    const FrameErrors before = FrameErrors::of(method_before, truth_before, plane),
                      now = FrameErrors::of(method_now, truth_now, plane);
    const BlockGrid grid(now.method.width(), now.method.height(), settings.bootstrap.block_size);
    return flicker_of(sum_changes(before, now, grid, settings.tolerance), settings.bootstrap);
}

}  // namespace plumb

// Temporal stability: how much a method's error changes from one frame to the next on the same surface point.
//
//   flicker = RMS over pixels p visible in both frames of  e_t(p) - e_{t-1}(p + motion_t(p)),   e = method - truth
//
// The truth's motion vectors are exact, so that no optical flow is estimated; what the truth itself does (lights that
// move, highlights) cancels in e. The warping errors of method and truth alone, RMS of I_t(p) - I_{t-1}(p + motion),
// are given beside it: they contain that change (compare Lai et al. 2018, "Learning Blind Video Temporal Consistency",
// which warps by estimated flow).
//
// A path-traced truth flickers by its own noise. Where it has halves A and B the mean squares are those of
// referenced_error.h, mean (change of M - A)(change of M - B) and mean (change of A)(change of B), which that noise
// does not bias: A and B are independent of each other in every frame, also where frames share their seed. Where the
// method has halves too (the oracle, itself path-traced), each is compared with the truth's half of that name, and the
// method's own noise biases nothing either. The 95 % interval is that of a block bootstrap over the squared changes.
//
// The value at p + motion is interpolated bilinearly; which pixels are visible in both frames, surface_motion.h says.
// The others (uncovered, outside the previous view, no surface, and surfaces that moved by themselves) are counted.
// Good for: shimmer of screen-space effects under a moving camera. Bad for: noise under motion by fractions of a pixel,
// which interpolation halves.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "frames/frame.h"
#include "metrics/block_bootstrap.h"
#include "metrics/surface_motion.h"

namespace plumb {

struct FlickerSettings {
    double tolerance = same_surface_tolerance;
    BootstrapSettings bootstrap;
};

struct Flicker {
    double rms = 0;                       // of the change of the error; NaN where no pixel is visible in both frames
    double rms_lower = 0, rms_upper = 0;  // 95 % interval
    double method_warping = 0;            // RMS change of the method's image
    double truth_warping = 0;             // RMS change of the truth
    double noise = 0;                     // RMS change that the truth's noise would add to that of the error
    std::size_t pixels = 0;               // visible in both frames and finite
    std::size_t not_visible = 0;
    std::size_t non_finite = 0;  // visible, but a value is infinite or NaN
};

// The truth's frame of now needs planes motion, position and depth, the one of before position; both frames of method
// and truth need `plane`; halves of the truth's count where both truths have them, and halves of the method's beside
// those. Motion is in pixels, from the place now to the place before. Throws ImageError for missing planes and
// different shapes.
Flicker flicker(const Frame& method_before, const Frame& truth_before, const Frame& method_now, const Frame& truth_now,
                std::string_view plane, const FlickerSettings& settings = {});

// What stability needs to know of one frame of a method and its truth.
struct FrameErrors {
    Image method;                   // its first half where it has halves
    Image second_half;              // empty where it has none
    Image error_a, error_b;         // method - truth, against each half; the same where the truth has no halves
    Image motion, depth, position;  // the truth's; motion and depth may be missing of a frame with none after it

    static FrameErrors of(const Frame& method, const Frame& truth, std::string_view plane);
};

// Sums of squared changes from one frame to the next, over the values of each block of `grid`.
struct ChangeSums {
    std::vector<BlockSum> error, method, truth, noise;
    std::size_t pixels = 0, not_visible = 0, non_finite = 0;
};

// Pixels of now that are zero in the mask do not count at all.
ChangeSums sum_changes(const FrameErrors& before, const FrameErrors& now, const BlockGrid& grid, double tolerance,
                       const Image* mask = nullptr);
Flicker flicker_of(const ChangeSums& sums, const BootstrapSettings& settings);

}  // namespace plumb

// Temporal stability: how much a method's error changes from one frame to the next on the same surface point.
//
//   flicker = RMS over pixels p visible in both frames of  e_t(p) - e_{t-1}(p + motion_t(p)),   e = method - truth
//
// The truth's motion vectors are exact, so that no optical flow is estimated; what the truth itself does (lights that
// move, highlights) cancels in e. The warping errors of method and truth alone, RMS of I_t(p) - I_{t-1}(p + motion),
// are given beside it: they contain that change (compare Lai et al. 2018, "Learning Blind Video Temporal Consistency",
// which warps by estimated flow).
//
// The value at p + motion is interpolated bilinearly. A pixel counts where all of the up to four pixels that the
// interpolation reads show the same surface: their world positions lie within `tolerance` times the pixel's depth of
// its own. The others (uncovered, outside the previous view, no surface, and surfaces that moved by themselves) are
// counted. Good for: shimmer of screen-space effects under a moving camera. Bad for: noise under motion by fractions of
// a pixel, which interpolation halves.
#pragma once

#include <cstddef>
#include <string_view>

#include "frames/frame.h"

namespace plumb {

struct FlickerSettings {
    // A pixel is 0.2 % of its depth wide (60 degrees over 640 pixels); 2 % lets surfaces seen at a slope of 10 : 1
    // pass.
    double tolerance = 0.02;
};

struct Flicker {
    double rms = 0;             // of the change of the error; NaN where no pixel is visible in both frames
    double method_warping = 0;  // RMS change of the method's image
    double truth_warping = 0;   // RMS change of the truth
    std::size_t pixels = 0;     // visible in both frames and finite
    std::size_t not_visible = 0;
    std::size_t non_finite = 0;  // visible, but a value is infinite or NaN
};

// The truth's frame of now needs planes motion, position and depth, the one of before position; both frames of method
// and truth need `plane`. Motion is in pixels, from the place now to the place before. Throws ImageError for missing
// planes and different shapes.
Flicker flicker(const Frame& method_before, const Frame& truth_before, const Frame& method_now, const Frame& truth_now,
                std::string_view plane, const FlickerSettings& settings = {});

}  // namespace plumb

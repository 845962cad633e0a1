// Where the surface point that a pixel shows was in the frame before, and whether it was visible there.
//
// Exact motion vectors point from each pixel of now to a place between four pixels of before. The point was visible
// there where all of these pixels that a bilinear look-up needs show the same surface: their world positions are no
// farther from its own than `tolerance` times the pixel's depth, or than twice the step to the nearer neighbours, which
// lets small images and surfaces seen at a slope pass, up to five times the tolerance. Surfaces that moved by
// themselves count as not visible.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "frames/frame.h"

namespace plumb {

// Whether a pixel with this depth shows a surface at all.
inline bool is_surface(double depth) { return std::isfinite(depth) && depth > 0.0; }

// The four pixels of a bilinear look-up and their weights; those of weight 0 may lie outside the image.
struct BilinearPlace {
    struct Tap {
        int x = 0, y = 0;
        double weight = 0;
    };
    std::array<Tap, 4> taps;

    // At continuous pixel indices: (0, 0) is the centre of the first pixel.
    static BilinearPlace at(double x, double y);
    double look_up(const Image& image, int channel) const;
    // Whether every pixel with weight lies in an image of that size.
    bool inside(int width, int height) const;
};

// The width of ten pixels of 640 over 60 degrees: more than rounding and interpolation move a point, less than most
// surfaces lie behind each other.
inline constexpr double same_surface_tolerance = 0.02;

// Metres around the position of pixel (x, y) within which the same surface lies.
double same_surface_radius(const Image& position, double depth, int x, int y,
                           double tolerance = same_surface_tolerance);

// True where all pixels of `place` that have weight lie inside and show positions within `radius` metres of `position`.
bool shows_surface(const BilinearPlace& place, const Image& positions, const std::array<double, 3>& position,
                   double radius);

// Where the surface of pixel (x, y) was before; nothing where it was not visible or the pixel shows no surface. Planes
// of now: motion (pixels, from the place now to the place before), depth; world positions of now and of before.
std::optional<BilinearPlace> place_before(const Image& motion, const Image& depth, const Image& position,
                                          const Image& position_before, int x, int y,
                                          double tolerance = same_surface_tolerance);

// Throws ImageError unless `frame` has motion, depth and position with 2, 1 and 3 channels; `what` names the frame in
// the message, such as "the truth".
void require_motion(const Frame& frame, const char* what);

}  // namespace plumb

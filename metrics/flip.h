// FLIP: how visible the difference of two images is to who flips between them on a screen, 0 (not at all) to 1.
//
// Both images are filtered by the eye's contrast sensitivity in an opponent colour space and compared in a uniform one,
// (HyAB distance, Hunt-adjusted CIELAB) for the colour difference c; edges and points of their unfiltered lightness
// are compared for the feature difference f; FLIP = c^(1 - f).
//   Source: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A Difference Evaluator for
//   Alternating Images"; for high dynamic range Andersson, Nilsson, Shirley, Akenine-Moeller 2021, "Visualizing Errors
//   in Rendered High Dynamic Range Images"; constants as in version 1.6 of the authors' program. Good for: how bad a
//   viewer finds a difference. Bad for: energy that is lost or found evenly, which a squared error shows better.
//
// Images are linear Rec.709, with one channel (grey) or three. Beyond the image lies its edge pixel again. A pixel that
// is not finite in either image is black in both for its neighbours, and NaN in the result.
#pragma once

#include "frames/image.h"

namespace plumb {

// A screen of 3840 pixels over 0.7 m, seen from 0.7 m.
inline constexpr double flip_pixels_per_degree = 67.02064327658226;

// Of values that a screen shows as they are: clamped to 0..1. One channel. Throws ImageError where shapes differ, where
// there are two channels or more than three, or where the pixels per degree are not positive.
Image ldr_flip(const Image& test, const Image& reference, double pixels_per_degree = flip_pixels_per_degree);

// Exposures in stops, `count` of them evenly from the first to the last.
struct ExposureRange {
    double first = 0.0, last = 0.0;
    int count = 2;
};

// From the exposure that makes the brightest pixel nearly white to the one that does so with the median pixel. It
// follows from the reference alone: one range for all that is compared with it. Where more than half of the pixels are
// black the median is that of the others (the source's is infinite). Throws ImageError where no pixel is brighter than
// black.
ExposureRange exposure_range(const Image& reference);

// Of radiance: at every exposure both images are tone-mapped (ACES, as the source has it by default) and compared;
// each pixel keeps its largest difference.
Image hdr_flip(const Image& test, const Image& reference, const ExposureRange& exposures,
               double pixels_per_degree = flip_pixels_per_degree);

// Over the pixels that count and are finite; NaN where there is none.
double mean_flip(const Image& flip, const Image* mask = nullptr);

}  // namespace plumb

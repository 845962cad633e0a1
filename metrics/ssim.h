// Structural similarity (SSIM): 1 for equal images, lower the more local brightness, contrast and structure differ.
//
//   SSIM = (2 mu_v mu_r + C1)(2 cov_vr + C2) / ((mu_v^2 + mu_r^2 + C1)(var_v + var_r + C2)),  C_i = (K_i *
//   data_range)^2
//
// with K1 = 0.01, K2 = 0.03 and local moments under an 11x11 Gaussian window of sigma 1.5; population covariance.
//   Source: Wang, Bovik, Sheikh, Simoncelli 2004, "Image Quality Assessment: From Error Visibility to Structural
//   Similarity". Definition shared with scikit-image's structural_similarity(gaussian_weights=True, sigma=1.5,
//   use_sample_covariance=False, data_range=...): pixels outside are mirrored (edge pixel doubled), the mean runs over
//   the pixels at least 5 away from each border, and over channels after each was computed by itself.
//
// The data range is an argument: radiance has none of its own, and a guessed one changes the result. Here SSIM is taken
// of linear values. Good for: structure such as missing contact shadows. Bad for: images of a few bright pixels, where
// C1 and C2 drown all the rest.
#pragma once

#include <cstddef>

#include "frames/image.h"

namespace plumb {

inline constexpr int ssim_window = 11;

struct Ssim {
    double mean = 0;  // NaN where no window is left
    double data_range = 0;
    std::size_t windows = 0;             // pixels times channels that the mean runs over
    std::size_t non_finite_windows = 0;  // left out because a value in the window is infinite or NaN
};

// The mask chooses window centres; windows still see the pixels around them. Throws ImageError where shapes differ, an
// image is smaller than the window or the data range is not positive.
Ssim ssim(const Image& test, const Image& reference, double data_range, const Image* mask = nullptr);

// Multi-scale SSIM: contrast and structure (the second factor above) at five scales, each half as large as the one
// before (means of 2x2 pixels), and brightness at the coarsest,
//
//   MS-SSIM = SSIM_5^w_5  prod_(j < 5) (mean contrast and structure)_j^w_j,   w = 0.0448, 0.2856, 0.3001, 0.2363,
//   0.1333
//
// with each mean taken as SSIM's; a negative mean counts as 0.
//   Source: Wang, Simoncelli, Bovik 2003, "Multi-scale Structural Similarity for Image Quality Assessment". Good for:
//   structure seen from several distances. Bad for: as SSIM.
// NaN where a scale has no finite window. Throws ImageError as ssim does, and for images whose smaller side is shorter
// than 176 pixels: at the coarsest scale a window would not fit.
inline constexpr int multi_scale_ssim_least_side = ssim_window * 16;
double multi_scale_ssim(const Image& test, const Image& reference, double data_range);

// SSIM at every pixel and channel, borders included; NaN where the window holds a value that is not finite.
Image ssim_map(const Image& test, const Image& reference, double data_range);

}  // namespace plumb

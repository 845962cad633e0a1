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
#include <vector>

#include "frames/image.h"
#include "metrics/block_bootstrap.h"

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

enum class SsimPart { all, contrast_and_structure };

// SSIM, or its second factor alone, at every pixel and channel, borders included: made once, and read over as many
// masks as wanted. NaN where the window holds a value that is not finite. Throws ImageError as ssim does.
class SsimMap {
public:
    SsimMap(const Image& test, const Image& reference, double data_range, SsimPart part = SsimPart::all);

    Ssim mean(const Image* mask = nullptr) const;
    // Of the windows that mean() runs over. `scale` pixels of the grid's image in a row make one of this one's.
    std::vector<BlockSum> block_sums(const BlockGrid& grid, const Image* mask = nullptr, int scale = 1) const;
    Image image() const;

private:
    std::size_t index(int x, int y, int channel) const {
        return (static_cast<std::size_t>(channel) * static_cast<std::size_t>(height_) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }
    template <typename Use>
    void for_each_window(const Image* mask, const Use& use) const;

    int width_, height_, channels_;
    double data_range_;
    std::vector<double> values_;  // channel after channel
};

// The maps of all scales, for multi_scale_ssim() and its interval. Throws ImageError as that does.
class MultiScaleSsim {
public:
    MultiScaleSsim(const Image& test, const Image& reference, double data_range);

    double value() const;
    // Sums whose mean over all blocks is value(), and which move with a block that is drawn again as value() does, to
    // first order (the delta method). Windows of the coarser scales are wider than most blocks, so that intervals made
    // of these are too narrow where the differences lie there.
    std::vector<BlockSum> block_sums(const BlockGrid& grid) const;

private:
    std::vector<SsimMap> maps_;  // the finest first
    std::vector<double> means_;
};

}  // namespace plumb

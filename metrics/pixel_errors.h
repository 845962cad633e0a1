// Errors that look at each value by itself.
//
// v is a value (one channel of one pixel) of the image under test, r the same value of the reference; every mean runs
// over all values of the pixels that count. Accumulated in double precision.
//
//   mae             mean |v - r|
//   mse, rmse       mean (v - r)^2 and its root
//   bias            mean (v - r): positive where the image is brighter than the reference
//   reference_mean  mean r, of which the bias is a share
//   relative MSE    mean (v - r)^2 / w(r), of which three definitions are in use; the numbers differ a lot in the dark:
//     pbrt            w = (r + 0.01)^2    pbrt-v4, util/image.cpp, Image::MRSE
//     tev             w = r^2 + 0.01      tev, UberShader.cpp, "relative squared error"
//     falcor          w = r^2 + 0.001     Falcor, ImageCompare.cpp, where it is called RMSE although no root is taken
//   psnr            10 log10(peak^2 / mse), infinite for equal images; the peak is an argument because radiance has
//   none of
//                   its own, and is part of the result
//   percentiles     of |v - r|, linear between order statistics (NumPy's default, Hyndman and Fan's type 7)
//
// A value that is not finite in either image has no error: it is left out of every mean and counted, so that a caller
// can refuse the comparison. Good for: gating and for sorting methods. Bad for: what an eye sees; see ssim.h.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "frames/image.h"

namespace plumb {

// w(r) of the definitions of relative MSE, by the names that measures have.
constexpr double relative_weight_pbrt(double r) { return (r + 0.01) * (r + 0.01); }
constexpr double relative_weight_tev(double r) { return r * r + 0.01; }
constexpr double relative_weight_falcor(double r) { return r * r + 0.001; }
struct RelativeMse {
    std::string_view name;
    double (*weight)(double reference);
};
inline constexpr std::array<RelativeMse, 3> relative_mses = {{{"relative_mse_pbrt", relative_weight_pbrt},
                                                              {"relative_mse_tev", relative_weight_tev},
                                                              {"relative_mse_falcor", relative_weight_falcor}}};

struct PixelErrors {
    std::size_t values = 0;                // that were compared
    std::size_t non_finite_test = 0;       // infinite or NaN under test
    std::size_t non_finite_reference = 0;  // ... in the reference; a value can be in both counts
    std::size_t left_out = 0;              // values not compared because one or both are not finite

    double mae = 0, mse = 0, rmse = 0, bias = 0, reference_mean = 0;
    double relative_mse_pbrt = 0, relative_mse_tev = 0, relative_mse_falcor = 0;
    double peak = 0, psnr = 0;
    double median = 0, percentile_95 = 0, percentile_99 = 0, maximum = 0;  // of |v - r|
};

// Throws ImageError where shapes differ, the mask does not fit, the peak is not positive, or no value is left to
// compare.
PixelErrors pixel_errors(const Image& test, const Image& reference, double peak, const Image* mask = nullptr);

// The level below which the fraction p (0..1) of the image's finite values lie, interpolated as above; NaN where no
// value is finite.
double value_percentile(const Image& image, double p, const Image* mask = nullptr);

}  // namespace plumb

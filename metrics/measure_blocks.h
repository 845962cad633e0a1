// What the measures of a plane are made of, block by block of the image: what their 95 % intervals are drawn from.
//
// A mean (mae, mse, bias, the relative MSE, SSIM, FLIP) is drawn as such (block_bootstrap.h). rmse and psnr follow from
// mse, and so do their intervals. MS-SSIM, a product of means, is drawn to first order (ssim.h). A percentile q of the
// errors is turned round: drawn is the share of errors up to q, and the interval's ends are the errors up to which the
// drawn shares lie (Woodruff 1952, "Confidence Intervals for Medians and Other Position Measures"). A maximum has no
// interval: no draw can show an error that the image does not.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frames/image.h"
#include "metrics/block_bootstrap.h"
#include "metrics/pixel_errors.h"
#include "metrics/quantile_curve.h"

namespace plumb {

// The percentiles of |v - r| that are measured.
struct PercentileMeasure {
    std::string_view name;
    double level;
    double PixelErrors::*value;
};
inline constexpr std::array<PercentileMeasure, 3> percentile_measures = {{{"median", 0.5, &PixelErrors::median},
                                                                          {"p95", 0.95, &PixelErrors::percentile_95},
                                                                          {"p99", 0.99, &PixelErrors::percentile_99}}};

struct MeasureBlocks {
    // Sums per block, whose mean over all blocks is the measure; without values where it does not exist.
    std::vector<BlockSum> mae, mse, bias, relative_mse_pbrt, relative_mse_tev, relative_mse_falcor, ssim, ms_ssim, flip;
    // Of each of percentile_measures: errors that are not above it.
    std::array<std::vector<BlockSum>, percentile_measures.size()> below;
    QuantileCurve magnitudes;
};

// The measures that are means, by name.
struct MeanMeasure {
    std::string_view name;
    std::vector<BlockSum> MeasureBlocks::*blocks;
};
inline constexpr std::array<MeanMeasure, 9> mean_measures = {
    {{"mae", &MeasureBlocks::mae},
     {"mse", &MeasureBlocks::mse},
     {"bias", &MeasureBlocks::bias},
     {"relative_mse_pbrt", &MeasureBlocks::relative_mse_pbrt},
     {"relative_mse_tev", &MeasureBlocks::relative_mse_tev},
     {"relative_mse_falcor", &MeasureBlocks::relative_mse_falcor},
     {"ssim", &MeasureBlocks::ssim},
     {"ms_ssim", &MeasureBlocks::ms_ssim},
     {"flip", &MeasureBlocks::flip}}};

// The part that pixel_errors() knows; `errors` is its result of the same images and mask.
MeasureBlocks pixel_error_blocks(const Image& test, const Image& reference, const PixelErrors& errors,
                                 const BlockGrid& grid, const Image* mask = nullptr);

// Of an image of one channel: its finite values at pixels that count.
std::vector<BlockSum> block_sums(const Image& map, const BlockGrid& grid, const Image* mask = nullptr);

// PSNR: 10 log10(peak^2 / mse); infinite where an unbiased estimate is not positive.
Estimate decibels(const Estimate& mse, double peak);

// Percentile `value` at `level`; `share` are the drawn shares of the errors up to it.
Estimate percentile_interval(double value, double level, const Estimate& share, const QuantileCurve& magnitudes);

// Named intervals; a name that is not there is NaN.
class MeasureIntervals {
public:
    Estimate of(std::string_view name) const;
    void set(std::string name, const Estimate& estimate);
    // mse, and with it rmse and psnr.
    void set_mse(const Estimate& mse, double peak);
    // Values and ends, among measures as PlaneComparison::measures() has them.
    void replace_in(std::vector<std::pair<std::string, double>>& measures) const;

private:
    std::vector<std::pair<std::string, Estimate>> estimates_;
};

// Of one image.
MeasureIntervals measure_intervals(const MeasureBlocks& blocks, const PixelErrors& errors,
                                   const BootstrapSettings& settings = {});

}  // namespace plumb

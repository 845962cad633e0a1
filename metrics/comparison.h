// Every measure of one plane against its reference, and of all planes of a frame: what tables, JSON files and
// thresholds read.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frames/frame.h"
#include "metrics/flip.h"
#include "metrics/pixel_errors.h"
#include "metrics/referenced_error.h"
#include "metrics/ssim.h"

namespace plumb {

// Which FLIP is taken.
enum class FlipRange {
    none,       // it costs more than all other measures together
    by_plane,   // displayed for ao, alpha, albedo and confidence, none for geometry, radiance for all others
    displayed,  // ldr_flip
    radiance,   // hdr_flip over the reference's exposure_range; none where the reference is black
};

struct ComparisonSettings {
    // Peak of PSNR and data range of SSIM. Not given: default_data_range of each plane's reference.
    std::optional<double> data_range;
    FlipRange flip = FlipRange::none;
    ReferencedErrorSettings referenced;  // its mask counts for every measure
};

// 1 for ao, alpha and albedo, 2 for normals. Otherwise the 99th percentile of the reference's finite values: the level
// that an exposure would make white, which a visible lamp or a few fireflies do not set. The largest value where that
// is not positive, 1 where no value is. Callers state the range beside every PSNR and SSIM.
double default_data_range(std::string_view plane, const Image& reference, const Image* mask = nullptr);

// Whether a plane says where things are, not how they look: depth, normal, motion... of any layer.
bool is_geometry_plane(std::string_view plane);

// Samples per pixel of a reference, by its fact "samples"; 0 where it does not say.
int samples_of(const Frame& reference);

struct PlaneComparison {
    std::string plane;
    PixelErrors errors;
    std::optional<Ssim> ssim;                   // none for images smaller than its window
    std::optional<double> multi_scale_ssim;     // none for images smaller than its windows at the coarsest scale
    std::optional<double> flip;                 // mean
    std::optional<ExposureRange> exposures;     // of the flip, where it is that of radiance
    std::optional<ReferencedError> referenced;  // where the reference has half-buffers

    // All measures in a fixed order under fixed names, the same for every plane; NaN where one does not exist:
    // mae, mse, rmse, bias, relative_mse_pbrt, relative_mse_tev, relative_mse_falcor, psnr, ssim, ms_ssim, flip,
    // flip_first_exposure, flip_last_exposure (stops; of radiance), median, p95, p99, maximum, data_range, values,
    // left_out, unbiased_mse, unbiased_mse_lower, unbiased_mse_upper, unbiased_rmse, reference_noise_mse, noise_ratio,
    // trustworthy (1 or 0).
    std::vector<std::pair<std::string, double>> measures() const;
    double measure(std::string_view name) const;  // throws ImageError that lists the names

    // The mean squared error to rely on: free of the reference's noise where the reference allows it, plain otherwise.
    double best_mse() const { return referenced ? referenced->mse : errors.mse; }
};

// The names that measures() uses, in its order.
const std::vector<std::string>& measure_names();

PlaneComparison compare_planes(const Image& test, const Image& reference, const ComparisonSettings& settings = {},
                               std::string_view plane = "total");

struct FrameComparison {
    std::vector<PlaneComparison> planes;  // those that both frames have, in order of their names
    std::vector<std::string> only_in_test, only_in_reference;
};

// Compares all planes that both frames have, except those derived from others (half_a., half_b., variance.), and with
// the reference's half-buffers where it has them; its fact "samples" says how many samples they hold. Where the test
// has half-buffers too, the unbiased_* measures take its noise for no error (referenced_error.h). Throws ImageError
// where sizes differ or no plane is common.
FrameComparison compare_frames(const Frame& test, const Frame& reference, const ComparisonSettings& settings = {});

}  // namespace plumb

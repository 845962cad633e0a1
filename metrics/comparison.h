// Every measure of one plane against its reference, over the whole image and over regions of it, and of all planes of a
// frame: what tables, JSON files and thresholds read.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frames/frame.h"
#include "metrics/flip.h"
#include "metrics/measure_blocks.h"
#include "metrics/pixel_errors.h"
#include "metrics/referenced_error.h"
#include "metrics/regions.h"
#include "metrics/ssim.h"

namespace plumb {

// Which FLIP is taken.
enum class FlipRange {
    none,       // for where its time matters: it costs more than all other measures together
    by_plane,   // displayed for ao, alpha, albedo and confidence, none for geometry, radiance for all others
    displayed,  // ldr_flip
    radiance,   // hdr_flip over the reference's exposure_range; none where the reference is black
};

// "none", "by_plane", "displayed", "radiance", in this order.
const std::vector<std::string>& flip_range_names();
std::string to_string(FlipRange range);

struct ComparisonSettings {
    // Peak of PSNR and data range of SSIM. Not given: default_data_range of each plane's reference.
    std::optional<double> data_range;
    FlipRange flip = FlipRange::none;
    double pixels_per_degree = flip_pixels_per_degree;
    std::optional<ExposureRange> exposures;  // of the FLIP of radiance; not given: exposure_range of the reference
    ReferencedErrorSettings referenced;      // its mask and its bootstrap count for every measure
    bool intervals = true;                   // of every comparison by itself
    bool keep_blocks = false;                // for a MeasureSeries: sums over blocks that all images of one size share
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
    std::string region;      // empty: the whole image
    std::size_t pixels = 0;  // of the region
    PixelErrors errors;
    std::optional<Ssim> ssim;                   // none for images smaller than its window
    std::optional<double> multi_scale_ssim;     // none for images smaller than its windows at the coarsest scale
    std::optional<double> flip;                 // mean
    std::optional<ExposureRange> exposures;     // of the flip, where it is that of radiance
    std::optional<ReferencedError> referenced;  // where the reference has half-buffers
    MeasureIntervals intervals;                 // where the settings ask for them
    std::optional<MeasureBlocks> blocks;        // likewise
    std::optional<ErrorSums> error_sums;        // likewise; where the reference has half-buffers

    // All measures in a fixed order under fixed names, the same for every plane; NaN where one does not exist:
    // mae, mse, rmse, bias, relative_mse_pbrt, relative_mse_tev, relative_mse_falcor, psnr, ssim, ms_ssim, flip,
    // flip_first_exposure, flip_last_exposure (stops; of radiance), median, p95, p99, maximum, data_range,
    // reference_mean, values, left_out, unbiased_mse, unbiased_rmse, unbiased_relative_mse_pbrt,
    // unbiased_relative_mse_tev, unbiased_relative_mse_falcor, unbiased_psnr, reference_noise_mse, noise_ratio,
    // trustworthy (1 or 0). Each that has_interval() is followed by the ends of its 95 % interval, NAME_lower and
    // NAME_upper.
    std::vector<std::pair<std::string, double>> measures() const;
    double measure(std::string_view name) const;  // throws ImageError that lists the names

    // The mean squared error to rely on: free of the reference's noise where the reference allows it, plain otherwise.
    double best_mse() const { return referenced ? referenced->mse : errors.mse; }
};

// The names that measures() uses, in its order.
const std::vector<std::string>& measure_names();
// Whether a measure has an interval: all that say how far apart images are, except the maximum (measure_blocks.h).
bool has_interval(std::string_view measure);

// Replaces, among measures under these names, those that halves of the reference tell. `peak`: of the PSNR.
void set_referenced(std::vector<std::pair<std::string, double>>& measures, const ReferencedError& error, double peak);
void set_measure(std::vector<std::pair<std::string, double>>& measures, std::string_view name, double value);

// FLIP at every pixel, as the settings have it of that plane; nothing where they have none.
struct FlipMap {
    Image map;
    std::optional<ExposureRange> exposures;  // of radiance
};
std::optional<FlipMap> flip_map(const Image& test, const Image& reference, const ComparisonSettings& settings,
                                std::string_view plane);

PlaneComparison compare_planes(const Image& test, const Image& reference, const ComparisonSettings& settings = {},
                               std::string_view plane = "total");

// One plane of two frames: the whole image first, then those of the regions that hold values. Maps of SSIM and FLIP are
// made once, and data range and exposures are those of the whole image. With the reference's half-buffers where it has
// them; its fact "samples" says how many samples they hold. Without intervals no noise can be told to be small enough:
// then nothing is trustworthy.
std::vector<PlaneComparison> compare_plane(const Frame& test, const Frame& reference, const std::string& plane,
                                           const ComparisonSettings& settings = {},
                                           const std::vector<Region>& regions = {});

// Which planes two frames have, in order of their names, except those derived from others (half_a., half_b.,
// variance.).
struct PlanePairs {
    std::vector<std::string> common, only_in_test, only_in_reference;
};
// Throws ImageError where no plane is common.
PlanePairs pair_planes(const Frame& test, const Frame& reference);

struct FrameComparison {
    std::vector<PlaneComparison> planes;  // those that both frames have, in order of their names
    std::vector<std::string> only_in_test, only_in_reference;
};

// Compares the planes that pair_planes() finds in both frames, with the reference's half-buffers where it has them; its
// fact "samples" says how many samples they hold. Where the test has half-buffers too, the unbiased_* measures take its
// noise for no error (referenced_error.h). Throws ImageError where sizes differ or no plane is common.
FrameComparison compare_frames(const Frame& test, const Frame& reference, const ComparisonSettings& settings = {});

}  // namespace plumb

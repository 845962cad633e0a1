#include "metrics/comparison.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "frames/image_error.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

std::string_view last_part(std::string_view plane) {
    const auto dot = plane.rfind('.');
    return dot == std::string_view::npos ? plane : plane.substr(dot + 1);
}

FlipRange flip_range(FlipRange asked, std::string_view plane, const Image& reference) {
    if (asked != FlipRange::by_plane) return asked;
    const auto name = last_part(plane);
    const auto is_one_of = [&](std::initializer_list<std::string_view> names) {
        return std::ranges::find(names, name) != names.end();
    };
    if (is_one_of({"ao", "alpha", "albedo", "confidence"})) return FlipRange::displayed;
    const bool is_colour = reference.channels() == 1 || reference.channels() == 3;
    return is_colour && !is_geometry_plane(plane) ? FlipRange::radiance : FlipRange::none;
}

std::vector<std::string> planes_to_compare(const Frame& frame) {
    auto names = frame.plane_names();
    std::erase_if(names, [](const std::string& name) { return is_derived_plane(name); });
    return names;
}

// One plane of an image beside its reference, to be measured over several masks: what costs most, the maps of SSIM and
// FLIP, is made once.
class PlaneMeasurement {
public:
    PlaneMeasurement(const Image& test, const Image& reference, const ComparisonSettings& settings,
                     std::string_view plane)
        : test_(test), reference_(reference), settings_(settings), plane_(plane) {
        require_same_shape(test, reference, fmt::format("plane '{}'", plane));
        const Image* mask = settings.referenced.mask;
        data_range_ = settings.data_range ? *settings.data_range : default_data_range(plane, reference, mask);
        if (test.width() >= ssim_window && test.height() >= ssim_window) ssim_.emplace(test, reference, data_range_);
        // The coarser scales have no mask.
        if (!mask && std::min(test.width(), test.height()) >= multi_scale_ssim_least_side)
            multi_scale_ssim_.emplace(test, reference, data_range_);
        flip_ = flip_map(test, reference, settings, plane);
    }

    PlaneComparison over(const Image* mask) const {
        PlaneComparison result;
        result.plane = plane_;
        result.errors = pixel_errors(test_, reference_, data_range_, mask);
        if (ssim_) result.ssim = ssim_->mean(mask);
        if (is_whole(mask) && multi_scale_ssim_) result.multi_scale_ssim = multi_scale_ssim_->value();
        if (flip_) result.flip = mean_flip(flip_->map, mask), result.exposures = flip_->exposures;
        if (settings_.keep_blocks) result.blocks = blocks(result.errors, grid(nullptr), mask);
        if (settings_.intervals) {
            result.intervals =
                measure_intervals(result.blocks && !mask ? *result.blocks : blocks(result.errors, grid(mask), mask),
                                  result.errors, settings_.referenced.bootstrap);
        }
        return result;
    }

    // With the halves that the reference has.
    void add_referenced(const Frame& test, const Frame& reference, const Image* mask, PlaneComparison& result) const {
        const int samples = samples_of(reference);
        if (settings_.keep_blocks) result.error_sums = sum_errors(test, reference, plane_, grid(nullptr), mask);
        if (settings_.intervals) {
            ReferencedErrorSettings within = settings_.referenced;
            within.mask = mask;
            result.referenced = referenced_error(test, reference, plane_, samples, within);
            return;
        }
        const ErrorSums sums =
            result.error_sums ? *result.error_sums : sum_errors(test, reference, plane_, grid(nullptr), mask);
        if (sums.values > 0) {
            result.referenced =
                referenced_error_of(sums, means_without_intervals(sums), samples, settings_.referenced.noise_limit);
        }
    }

private:
    BlockGrid grid(const Image* occupied) const {
        return {test_.width(), test_.height(), settings_.referenced.bootstrap.block_size, occupied};
    }

    bool is_whole(const Image* mask) const { return mask == settings_.referenced.mask; }

    MeasureBlocks blocks(const PixelErrors& errors, const BlockGrid& grid, const Image* mask) const {
        MeasureBlocks blocks = pixel_error_blocks(test_, reference_, errors, grid, mask);
        if (ssim_) blocks.ssim = ssim_->block_sums(grid, mask);
        if (is_whole(mask) && multi_scale_ssim_) blocks.ms_ssim = multi_scale_ssim_->block_sums(grid);
        if (flip_) blocks.flip = block_sums(flip_->map, grid, mask);
        return blocks;
    }

    const Image &test_, &reference_;
    const ComparisonSettings& settings_;
    std::string plane_;
    double data_range_ = 0.0;
    std::optional<SsimMap> ssim_;
    std::optional<MultiScaleSsim> multi_scale_ssim_;
    std::optional<FlipMap> flip_;
};

// Whether any value within the mask is finite on both sides.
bool has_values(const Image& test, const Image& reference, const Image& mask) {
    for (int y = 0; y < test.height(); ++y) {
        for (int x = 0; x < test.width(); ++x) {
            if (!pixel_counts(&mask, x, y)) continue;
            for (int c = 0; c < test.channels(); ++c) {
                if (std::isfinite(test.at(x, y, c)) && std::isfinite(reference.at(x, y, c))) return true;
            }
        }
    }
    return false;
}

}  // namespace

bool is_geometry_plane(std::string_view plane) {
    constexpr std::array<std::string_view, 8> names = {"depth",           "normal",       "motion",   "position",
                                                       "camera_position", "displacement", "instance", "seen_before"};
    return std::ranges::find(names, last_part(plane)) != names.end();
}

int samples_of(const Frame& reference) {
    const auto fact = reference.facts.find("samples");
    if (fact == reference.facts.end()) return 0;
    const std::string& text = fact->second;
    int samples = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), samples);
    return error == std::errc() && end == text.data() + text.size() ? samples : 0;
}

double default_data_range(std::string_view plane, const Image& reference, const Image* mask) {
    const auto name = last_part(plane);
    if (name == "ao" || name == "alpha" || name == "albedo") return 1.0;
    if (name == "normal") return 2.0;
    if (const double white = value_percentile(reference, 0.99, mask); white > 0.0) return white;
    if (const double largest = value_percentile(reference, 1.0, mask); largest > 0.0) return largest;
    return 1.0;
}

const std::vector<std::string>& measure_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const auto& [name, value] : PlaneComparison{}.measures()) list.push_back(name);
        return list;
    }();
    return names;
}

const std::vector<std::string>& flip_range_names() {
    static const std::vector<std::string> names = {"none", "by_plane", "displayed", "radiance"};
    return names;
}

std::string to_string(FlipRange range) { return flip_range_names().at(static_cast<std::size_t>(range)); }

std::optional<FlipMap> flip_map(const Image& test, const Image& reference, const ComparisonSettings& settings,
                                std::string_view plane) {
    const FlipRange range = flip_range(settings.flip, plane, reference);
    if (range == FlipRange::displayed) return FlipMap{ldr_flip(test, reference, settings.pixels_per_degree), {}};
    const bool shows = settings.exposures || value_percentile(reference, 1.0) > 0.0;
    if (range != FlipRange::radiance || !shows) return std::nullopt;
    const ExposureRange exposures = settings.exposures ? *settings.exposures : exposure_range(reference);
    return FlipMap{hdr_flip(test, reference, exposures, settings.pixels_per_degree), exposures};
}

bool has_interval(std::string_view measure) {
    constexpr std::array<std::string_view, 20> names = {"mae",
                                                        "mse",
                                                        "rmse",
                                                        "bias",
                                                        "relative_mse_pbrt",
                                                        "relative_mse_tev",
                                                        "relative_mse_falcor",
                                                        "psnr",
                                                        "ssim",
                                                        "ms_ssim",
                                                        "flip",
                                                        "median",
                                                        "p95",
                                                        "p99",
                                                        "unbiased_mse",
                                                        "unbiased_rmse",
                                                        "unbiased_relative_mse_pbrt",
                                                        "unbiased_relative_mse_tev",
                                                        "unbiased_relative_mse_falcor",
                                                        "unbiased_psnr"};
    return std::ranges::find(names, measure) != names.end();
}

void set_measure(std::vector<std::pair<std::string, double>>& measures, std::string_view name, double value) {
    const auto found = std::ranges::find(measures, name, &std::pair<std::string, double>::first);
    if (found != measures.end()) found->second = value;
}

void set_referenced(std::vector<std::pair<std::string, double>>& measures, const ReferencedError& error, double peak) {
    const auto set = [&](const std::string& name, const Estimate& estimate) {
        set_measure(measures, name, estimate.value);
        set_measure(measures, name + "_lower", estimate.lower);
        set_measure(measures, name + "_upper", estimate.upper);
    };
    const Estimate mse{error.mse, error.lower, error.upper};
    set("unbiased_mse", mse);
    set("unbiased_rmse", mse.root());
    for (std::size_t i = 0; i < relative_mses.size(); ++i)
        set(fmt::format("unbiased_{}", relative_mses[i].name), error.relative_mse[i]);
    set("unbiased_psnr", decibels(mse, peak));
    set_measure(measures, "reference_noise_mse", error.reference_noise_mse);
    set_measure(measures, "noise_ratio", error.ratio);
    set_measure(measures, "trustworthy", error.trustworthy ? 1.0 : 0.0);
}

std::vector<std::pair<std::string, double>> PlaneComparison::measures() const {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    std::vector<std::pair<std::string, double>> list;
    const auto add = [&](const char* name, double value) {
        list.emplace_back(name, value);
        if (!has_interval(name)) return;
        const Estimate estimate = intervals.of(name);
        list.emplace_back(fmt::format("{}_lower", name), estimate.lower);
        list.emplace_back(fmt::format("{}_upper", name), estimate.upper);
    };
    add("mae", errors.mae);
    add("mse", errors.mse);
    add("rmse", errors.rmse);
    add("bias", errors.bias);
    add("relative_mse_pbrt", errors.relative_mse_pbrt);
    add("relative_mse_tev", errors.relative_mse_tev);
    add("relative_mse_falcor", errors.relative_mse_falcor);
    add("psnr", errors.psnr);
    add("ssim", ssim ? ssim->mean : none);
    add("ms_ssim", multi_scale_ssim.value_or(none));
    add("flip", flip.value_or(none));
    add("flip_first_exposure", exposures ? exposures->first : none);
    add("flip_last_exposure", exposures ? exposures->last : none);
    add("median", errors.median);
    add("p95", errors.percentile_95);
    add("p99", errors.percentile_99);
    add("maximum", errors.maximum);
    add("data_range", errors.peak);
    add("reference_mean", errors.reference_mean);
    add("values", static_cast<double>(errors.values));
    add("left_out", static_cast<double>(errors.left_out));
    for (const char* name :
         {"unbiased_mse", "unbiased_rmse", "unbiased_relative_mse_pbrt", "unbiased_relative_mse_tev",
          "unbiased_relative_mse_falcor", "unbiased_psnr", "reference_noise_mse", "noise_ratio", "trustworthy"})
        add(name, none);
    if (referenced) set_referenced(list, *referenced, errors.peak);
    return list;
}

double PlaneComparison::measure(std::string_view name) const {
    for (const auto& [known, value] : measures()) {
        if (known == name) return value;
    }
    throw ImageError(fmt::format("unknown measure '{}'; use one of: {}", name, fmt::join(measure_names(), ", ")));
}

PlaneComparison compare_planes(const Image& test, const Image& reference, const ComparisonSettings& settings,
                               std::string_view plane) {
    return PlaneMeasurement(test, reference, settings, plane).over(settings.referenced.mask);
}

std::vector<PlaneComparison> compare_plane(const Frame& test, const Frame& reference, const std::string& plane,
                                           const ComparisonSettings& settings, const std::vector<Region>& regions) {
    const Image &image = test.plane(plane), &truth = reference.plane(plane);
    const PlaneMeasurement measurement(image, truth, settings, plane);
    std::vector<PlaneComparison> comparisons;
    const auto add = [&](const std::string& region, std::size_t pixels, const Image* mask) {
        PlaneComparison& comparison = comparisons.emplace_back(measurement.over(mask));
        comparison.region = region, comparison.pixels = pixels;
        if (has_halves(reference, plane)) measurement.add_referenced(test, reference, mask, comparison);
    };
    add("", image.pixel_count(), settings.referenced.mask);
    for (const Region& region : regions) {
        require_mask_fits(region.mask, image);
        if (region.pixels > 0 && has_values(image, truth, region.mask)) add(region.name, region.pixels, &region.mask);
    }
    return comparisons;
}

PlanePairs pair_planes(const Frame& test, const Frame& reference) {
    const auto in_test = planes_to_compare(test), in_reference = planes_to_compare(reference);
    PlanePairs pairs;
    std::ranges::set_intersection(in_test, in_reference, std::back_inserter(pairs.common));
    std::ranges::set_difference(in_test, in_reference, std::back_inserter(pairs.only_in_test));
    std::ranges::set_difference(in_reference, in_test, std::back_inserter(pairs.only_in_reference));
    if (pairs.common.empty()) {
        throw ImageError(fmt::format("the frames have no plane in common: {} against {} in the reference",
                                     fmt::join(in_test, ", "), fmt::join(in_reference, ", ")));
    }
    return pairs;
}

FrameComparison compare_frames(const Frame& test, const Frame& reference, const ComparisonSettings& settings) {
    PlanePairs pairs = pair_planes(test, reference);
    FrameComparison result;
    for (const std::string& plane : pairs.common)
        result.planes.push_back(std::move(compare_plane(test, reference, plane, settings).front()));
    result.only_in_test = std::move(pairs.only_in_test);
    result.only_in_reference = std::move(pairs.only_in_reference);
    return result;
}

}  // namespace plumb

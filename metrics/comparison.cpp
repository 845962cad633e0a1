#include "metrics/comparison.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
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

void add_flip(const Image& test, const Image& reference, FlipRange range, const Image* mask, PlaneComparison& result) {
    if (range == FlipRange::displayed) result.flip = mean_flip(ldr_flip(test, reference), mask);
    if (range != FlipRange::radiance || !(value_percentile(reference, 1.0) > 0.0)) return;
    result.exposures = exposure_range(reference);
    result.flip = mean_flip(hdr_flip(test, reference, *result.exposures), mask);
}

std::vector<std::string> planes_to_compare(const Frame& frame) {
    auto names = frame.plane_names();
    std::erase_if(names, [](const std::string& name) { return is_derived_plane(name); });
    return names;
}

PlaneComparison compare(const Image& test, const Image& reference, const ComparisonSettings& settings,
                        std::string_view plane) {
    require_same_shape(test, reference, fmt::format("plane '{}'", plane));
    const Image* mask = settings.referenced.mask;
    const double range = settings.data_range ? *settings.data_range : default_data_range(plane, reference, mask);
    PlaneComparison result;
    result.plane = plane;
    result.errors = pixel_errors(test, reference, range, mask);
    if (test.width() >= ssim_window && test.height() >= ssim_window) {
        result.ssim = ssim(test, reference, range, mask);
    }
    // The coarser scales have no mask.
    if (!mask && std::min(test.width(), test.height()) >= multi_scale_ssim_least_side) {
        result.multi_scale_ssim = multi_scale_ssim(test, reference, range);
    }
    add_flip(test, reference, flip_range(settings.flip, plane, reference), mask, result);
    return result;
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

std::vector<std::pair<std::string, double>> PlaneComparison::measures() const {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const auto of_reference = [&](double ReferencedError::*member) {
        return referenced ? (*referenced).*member : none;
    };
    return {
        {"mae", errors.mae},
        {"mse", errors.mse},
        {"rmse", errors.rmse},
        {"bias", errors.bias},
        {"relative_mse_pbrt", errors.relative_mse_pbrt},
        {"relative_mse_tev", errors.relative_mse_tev},
        {"relative_mse_falcor", errors.relative_mse_falcor},
        {"psnr", errors.psnr},
        {"ssim", ssim ? ssim->mean : none},
        {"ms_ssim", multi_scale_ssim.value_or(none)},
        {"flip", flip.value_or(none)},
        {"flip_first_exposure", exposures ? exposures->first : none},
        {"flip_last_exposure", exposures ? exposures->last : none},
        {"median", errors.median},
        {"p95", errors.percentile_95},
        {"p99", errors.percentile_99},
        {"maximum", errors.maximum},
        {"data_range", errors.peak},
        {"values", static_cast<double>(errors.values)},
        {"left_out", static_cast<double>(errors.left_out)},
        {"unbiased_mse", of_reference(&ReferencedError::mse)},
        {"unbiased_mse_lower", of_reference(&ReferencedError::lower)},
        {"unbiased_mse_upper", of_reference(&ReferencedError::upper)},
        {"unbiased_rmse", referenced ? std::sqrt(std::max(referenced->mse, 0.0)) : none},
        {"reference_noise_mse", of_reference(&ReferencedError::reference_noise_mse)},
        {"noise_ratio", of_reference(&ReferencedError::ratio)},
        {"trustworthy", referenced ? (referenced->trustworthy ? 1.0 : 0.0) : none},
    };
}

double PlaneComparison::measure(std::string_view name) const {
    for (const auto& [known, value] : measures()) {
        if (known == name) return value;
    }
    throw ImageError(fmt::format("unknown measure '{}'; use one of: {}", name, fmt::join(measure_names(), ", ")));
}

PlaneComparison compare_planes(const Image& test, const Image& reference, const ComparisonSettings& settings,
                               std::string_view plane) {
    return compare(test, reference, settings, plane);
}

FrameComparison compare_frames(const Frame& test, const Frame& reference, const ComparisonSettings& settings) {
    const auto in_test = planes_to_compare(test), in_reference = planes_to_compare(reference);
    FrameComparison result;
    std::vector<std::string> common;
    std::ranges::set_intersection(in_test, in_reference, std::back_inserter(common));
    std::ranges::set_difference(in_test, in_reference, std::back_inserter(result.only_in_test));
    std::ranges::set_difference(in_reference, in_test, std::back_inserter(result.only_in_reference));
    if (common.empty()) {
        throw ImageError(fmt::format("the frames have no plane in common: {} against {} in the reference",
                                     fmt::join(in_test, ", "), fmt::join(in_reference, ", ")));
    }
    const int samples = samples_of(reference);
    for (const std::string& plane : common) {
        auto& comparison =
            result.planes.emplace_back(compare(test.plane(plane), reference.plane(plane), settings, plane));
        if (reference.has("half_a." + plane) && reference.has("half_b." + plane)) {
            comparison.referenced = referenced_error(test, reference, plane, samples, settings.referenced);
        }
    }
    return result;
}

}  // namespace plumb

#include "experiments/error_maps.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "experiments/picture_look.h"
#include "frames/picture.h"
#include "metrics/error_image.h"
#include "metrics/ssim.h"

namespace plumb {

std::string_view name_of(ErrorMapKind kind) {
    constexpr std::array<std::string_view, 3> names = {"error", "flip", "ssim"};
    return names.at(static_cast<std::size_t>(kind));
}

std::optional<Image> error_map(ErrorMapKind kind, const Image& test, const Image& reference, std::string_view plane,
                               const ComparisonSettings& settings) {
    if (kind == ErrorMapKind::difference) return mean_of_channels(absolute_error(test, reference));
    if (kind == ErrorMapKind::flip) {
        std::optional<FlipMap> flip = flip_map(test, reference, settings, plane);
        return flip ? std::optional(std::move(flip->map)) : std::nullopt;
    }
    if (test.width() < ssim_window || test.height() < ssim_window) return std::nullopt;
    const double range = settings.data_range ? *settings.data_range : default_data_range(plane, reference);
    Image map = mean_of_channels(SsimMap(test, reference, range).image());
    for (float& value : map.values()) value = 1.0f - value;
    return map;
}

void write_error_map(const std::filesystem::path& file, const Image& map, double scale) {
    write_png(file, apply_colour_map(map, error_colour_map, 0.0f, static_cast<float>(scale)));
}

std::map<std::string, double> error_map_scales(const std::vector<MeasuredFrame>& frames, double fixed,
                                               ErrorMapKind kind) {
    std::map<std::string, double> scales;
    for (const MeasuredFrame& frame : frames) {
        for (const MeasuredThing& thing : frame.things) {
            if (const double p99 = thing.measure("p99"); thing.region.empty() && p99 >= 0.0)
                scales[thing.name] = std::max(scales[thing.name], p99);
        }
    }
    const bool is_difference = kind == ErrorMapKind::difference;
    for (auto& [plane, scale] : scales)
        scale = fixed > 0.0 ? fixed : is_difference && scale > 0.0 ? round_up_scale(scale) : 1.0;
    return scales;
}

std::string error_map_legend(const std::map<std::string, double>& scales, ErrorMapKind kind) {
    constexpr std::array<std::string_view, 3> shown = {"|difference|", "FLIP", "1 - SSIM"};
    std::string text;
    for (const auto& [plane, scale] : scales)
        text += fmt::format("{}: {} from 0 (black) to {:.4g} (yellow)\n", plane,
                            shown.at(static_cast<std::size_t>(kind)), scale);
    return text;
}

}  // namespace plumb

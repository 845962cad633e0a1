#include "experiments/error_maps.h"

#include <algorithm>

#include <fmt/format.h>

#include "experiments/picture_look.h"
#include "frames/picture.h"
#include "metrics/error_image.h"

namespace plumb {

void write_error_map(const std::filesystem::path& file, const Image& test, const Image& reference, double scale) {
    const Image error = mean_of_channels(absolute_error(test, reference));
    write_png(file, apply_colour_map(error, error_colour_map, 0.0f, static_cast<float>(scale)));
}

std::map<std::string, double> error_map_scales(const std::vector<MeasuredFrame>& frames, double fixed) {
    std::map<std::string, double> scales;
    for (const MeasuredFrame& frame : frames) {
        for (const MeasuredThing& thing : frame.things) {
            if (const double p99 = thing.measure("p99"); thing.region.empty() && p99 >= 0.0)
                scales[thing.name] = std::max(scales[thing.name], p99);
        }
    }
    for (auto& [plane, scale] : scales) scale = fixed > 0.0 ? fixed : scale > 0.0 ? round_up_scale(scale) : 1.0;
    return scales;
}

std::string error_map_legend(const std::map<std::string, double>& scales) {
    std::string text;
    for (const auto& [plane, scale] : scales)
        text += fmt::format("{}: |difference| from 0 (black) to {:.4g} (yellow)\n", plane, scale);
    return text;
}

}  // namespace plumb

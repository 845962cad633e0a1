#include "experiments/picture_look.h"

#include <cctype>
#include <cmath>

#include <fmt/format.h>

namespace plumb {

float exposure_for(double range) { return static_cast<float>(std::log2(0.9 / range)); }

std::string exposure_note(std::string_view plane, float exposure) {
    if (plane == "ao" || plane == "depth") return "";
    return fmt::format("pictures: exposure {:+.1f} stops, then sRGB", exposure);
}

double round_up_scale(double value) {
    if (!(value > 0.0) || !std::isfinite(value)) return 1e-6;
    const double magnitude = std::pow(10.0, std::floor(std::log10(value)));
    // Errors of float images: 0.1 is told as 0.10000002.
    for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
        if (value <= step * magnitude * (1.0 + 1e-6)) return step * magnitude;
    }
    return 10.0 * magnitude;
}

std::string file_name_of(std::string_view name) {
    std::string result(name);
    for (char& letter : result) {
        const bool plain = std::isalnum(static_cast<unsigned char>(letter)) || letter == '-' || letter == '_';
        if (!plain) letter = '_';
    }
    return result;
}

}  // namespace plumb

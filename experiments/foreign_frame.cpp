#include "experiments/foreign_frame.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/config_error.h"
#include "frames/image_error.h"

namespace plumb {
namespace {

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

// The first channel of an image whose channels are all the same.
Image as_one_channel(const Image& image, const std::string& plane, const std::string& file) {
    Image result(image.width(), image.height(), 1);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            const auto pixel = image.pixel(x, y);
            const bool same = std::ranges::all_of(
                pixel, [&](float value) { return value == pixel[0] || (std::isnan(value) && std::isnan(pixel[0])); });
            if (!same) {
                throw ImageError(fmt::format(
                    "{}: plane '{}' must have one channel, or channels that are equal; at pixel ({}, {}) they are {}",
                    file, plane, x, y, fmt::join(pixel, ", ")));
            }
            result.at(x, y) = pixel[0];
        }
    }
    return result;
}

}  // namespace

std::map<std::string, std::string> parse_renamings(const std::vector<std::string>& texts) {
    std::map<std::string, std::string> renamings;
    for (const std::string& text : texts) {
        const auto equals = text.rfind('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
            throw ConfigError(fmt::format("renaming '{}': write it as THEIRS=OURS, such as DiffInd=indirect", text));
        renamings[text.substr(0, equals)] = text.substr(equals + 1);
    }
    return renamings;
}

bool is_light_plane(const std::string& plane) {
    return plane == "total" || plane == "ao" || plane == "direct" || plane == "indirect" ||
           plane.starts_with("indirect.") || plane == "irradiance" || plane == "reflection" || plane == "emission";
}

Frame with_our_names(Frame frame, const std::map<std::string, std::string>& renamings, const std::string& file) {
    for (const auto& [theirs, ours] : renamings) {
        if (!frame.has(theirs)) {
            throw ImageError(fmt::format("{}: there is no plane '{}' to be taken for '{}'; there are {}", file, theirs,
                                         ours, fmt::join(frame.plane_names(), ", ")));
        }
    }
    Frame result(frame.width(), frame.height());
    result.facts = frame.facts;
    for (const std::string& theirs : frame.plane_names()) {
        const auto renaming = renamings.find(theirs);
        const std::string ours = renaming != renamings.end() ? renaming->second : lower_case(theirs);
        if (result.has(ours)) {
            throw ImageError(fmt::format("{}: two planes would be '{}'; rename one of {} with --rename", file, ours,
                                         fmt::join(frame.plane_names(), ", ")));
        }
        Image image = std::move(frame.plane(theirs));
        const bool scalar = ours == "ao" || ours == "depth" || ours.ends_with(".depth");
        if (scalar && image.channels() != 1) image = as_one_channel(image, ours, file);
        result.set(ours, std::move(image));
    }
    return result;
}

}  // namespace plumb

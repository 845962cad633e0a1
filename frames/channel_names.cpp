#include "frames/channel_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include <fmt/format.h>

#include "frames/image_error.h"

namespace plumb {
namespace {

// Suffix in capitals -> the channel's full name, for all channels of one layer.
using Suffixes = std::map<std::string, std::string>;

bool is_plane_or_ends_with(std::string_view plane, std::string_view name) {
    return plane == name || (plane.ends_with(name) && plane[plane.size() - name.size() - 1] == '.');
}

std::string capitals(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return result;
}

// The channels in the order of the first known group that has exactly these suffixes; empty where there is none.
std::vector<std::string> ordered(const Suffixes& suffixes) {
    constexpr std::array<std::string_view, 14> groups{"Y",  "Z",  "R",   "A",   "V",   "XY",   "UV",
                                                      "RG", "YA", "RGB", "XYZ", "UVA", "RGBA", "XYZW"};
    for (const std::string_view group : groups) {
        if (group.size() != suffixes.size()) continue;
        std::vector<std::string> channels;
        for (const char letter : group) {
            if (const auto found = suffixes.find(std::string(1, letter)); found != suffixes.end()) {
                channels.push_back(found->second);
            }
        }
        if (channels.size() == group.size()) return channels;
    }
    std::vector<std::string> channels;
    for (std::size_t i = 0; i < suffixes.size(); ++i) {
        const auto found = suffixes.find(std::to_string(i));
        if (found == suffixes.end()) return {};
        channels.push_back(found->second);
    }
    return channels;
}

// The channels without a layer: colour is `total`, A is `alpha`, Z is `depth`, unless a layer already has that name.
void group_root(Suffixes root, const std::map<std::string, Suffixes>& layers, std::vector<PlaneChannels>& planes) {
    const auto take = [&](std::string_view plane, std::string_view fallback, std::string_view letters) {
        PlaneChannels group{std::string(layers.contains(std::string(plane)) ? fallback : plane), {}};
        for (const char letter : letters) {
            const auto found = root.find(std::string(1, letter));
            if (found == root.end()) return;
            group.channels.push_back(found->second);
        }
        for (const char letter : letters) root.erase(std::string(1, letter));
        planes.push_back(std::move(group));
    };
    take("total", "root", "RGB");
    if (planes.empty() && !root.contains("X")) take("total", "root", "Y");
    if (!root.contains("X")) take("depth", "Z", "Z");
    take("alpha", "A", "A");
    for (const auto& [suffix, name] : root) planes.push_back({name, {name}});
}

}  // namespace

std::vector<std::string> channel_names(std::string_view plane, int channels) {
    if (plane.empty()) throw ImageError("a plane without a name cannot be written to a file; name it");
    if (channels < 1) throw ImageError(fmt::format("plane '{}' has no channels", plane));
    if (plane == "total") {
        if (channels == 1) return {"Y"};
        if (channels == 3) return {"R", "G", "B"};
        throw ImageError(fmt::format(
            "plane 'total' has {} channels; it is written as a file's root colour and must have 3 (RGB) or 1; "
            "coverage belongs into a plane 'alpha'",
            channels));
    }
    if (plane == "alpha") {
        if (channels == 1) return {"A"};
        throw ImageError(fmt::format("plane 'alpha' has {} channels; it must have 1", channels));
    }
    std::string_view letters;
    switch (channels) {
        case 1:
            letters = is_plane_or_ends_with(plane, "depth") ? "Z" : "Y";
            break;
        case 2:
            letters = "XY";
            break;
        case 3:
            letters =
                is_plane_or_ends_with(plane, "normal") || is_plane_or_ends_with(plane, "position") ? "XYZ" : "RGB";
            break;
        case 4:
            letters = "RGBA";
            break;
        default:
            break;
    }
    std::vector<std::string> names;
    names.reserve(static_cast<std::size_t>(channels));
    for (int i = 0; i < channels; ++i) {
        names.push_back(letters.empty() ? fmt::format("{}.{}", plane, i) : fmt::format("{}.{}", plane, letters[i]));
    }
    return names;
}

std::vector<PlaneChannels> group_channels(std::span<const std::string> names) {
    std::map<std::string, Suffixes> layers;
    Suffixes root;
    std::vector<PlaneChannels> planes, singles;
    for (const std::string& name : names) {
        const auto dot = name.rfind('.');
        Suffixes& layer = dot == std::string::npos || dot == 0 ? root : layers[name.substr(0, dot)];
        const auto suffix = capitals(dot == std::string::npos ? name : name.substr(dot + 1));
        // Two channels that differ by case only cannot share a plane.
        if (!layer.emplace(suffix, name).second) singles.push_back({name, {name}});
    }
    group_root(std::move(root), layers, planes);
    for (const auto& [layer, suffixes] : layers) {
        if (auto channels = ordered(suffixes); !channels.empty()) {
            planes.push_back({layer, std::move(channels)});
        } else {
            for (const auto& [suffix, name] : suffixes) planes.push_back({name, {name}});
        }
    }
    planes.insert(planes.end(), singles.begin(), singles.end());
    return planes;
}

}  // namespace plumb

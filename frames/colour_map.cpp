#include "frames/colour_map.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "frames/image_error.h"

namespace plumb {
namespace {

using Colour = std::array<float, 3>;

// Control points 0xRRGGBB, equally spaced.
constexpr unsigned viridis[] = {
    0x440154, 0x470d60, 0x48186a, 0x482374, 0x472d7b, 0x453681, 0x424086, 0x3f4989, 0x3b528b, 0x375a8d, 0x33638d,
    0x2f6a8e, 0x2c728e, 0x297a8e, 0x26818e, 0x23898e, 0x21908c, 0x1f988b, 0x1f9f88, 0x21a685, 0x28ae80, 0x31b57b,
    0x3ebc74, 0x4cc26c, 0x5dc963, 0x6ece58, 0x82d34c, 0x96d83f, 0xabdc32, 0xc0df24, 0xd5e21a, 0xeae51a, 0xfde725};
constexpr unsigned magma[] = {0x000004, 0x030311, 0x0a0822, 0x130d33, 0x1d1146, 0x28115a, 0x36106a, 0x430f76, 0x50127c,
                              0x5d177f, 0x691c81, 0x762181, 0x822681, 0x8f2a81, 0x9c2e7f, 0xa9327d, 0xb63779, 0xc33b75,
                              0xcf4170, 0xdb486a, 0xe65163, 0xee5c5e, 0xf5695c, 0xf9785d, 0xfb8761, 0xfd9668, 0xfea571,
                              0xfeb47b, 0xfec387, 0xfed194, 0xfde0a2, 0xfceeb0, 0xfcfdbf};
constexpr unsigned inferno[] = {
    0x000004, 0x040312, 0x0b0724, 0x150b37, 0x210c4a, 0x2e0a5a, 0x3c0965, 0x4a0c6b, 0x57106d, 0x63146e, 0x70196e,
    0x7d1e6d, 0x89226a, 0x962766, 0xa32b61, 0xaf315c, 0xbb3755, 0xc63e4d, 0xd14644, 0xdb4f3b, 0xe35932, 0xeb6528,
    0xf1711e, 0xf67f14, 0xf98d0a, 0xfb9c06, 0xfcab0f, 0xfbba1f, 0xf9ca32, 0xf5d949, 0xf2e865, 0xf3f586, 0xfcffa4};
constexpr unsigned diverging[] = {0x053061, 0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xf7f7f7,
                                  0xfddbc7, 0xf4a582, 0xd6604d, 0xb2182b, 0x67001f};

Colour from_hexadecimal(unsigned colour) {
    return {static_cast<float>(colour >> 16 & 0xff) / 255.0f, static_cast<float>(colour >> 8 & 0xff) / 255.0f,
            static_cast<float>(colour & 0xff) / 255.0f};
}

Colour interpolate(std::span<const unsigned> points, float t) {
    const float position = t * static_cast<float>(points.size() - 1);
    const std::size_t index = std::min(static_cast<std::size_t>(position), points.size() - 2);
    const Colour a = from_hexadecimal(points[index]), b = from_hexadecimal(points[index + 1]);
    Colour result;
    for (int c = 0; c < 3; ++c) result[c] = std::lerp(a[c], b[c], position - static_cast<float>(index));
    return result;
}

}  // namespace

std::string_view to_string(ColourMap map) {
    switch (map) {
        case ColourMap::viridis:
            return "viridis";
        case ColourMap::magma:
            return "magma";
        case ColourMap::inferno:
            return "inferno";
        case ColourMap::diverging:
            return "diverging";
    }
    return "";
}

ColourMap colour_map_from_string(std::string_view name) {
    for (const auto map : {ColourMap::viridis, ColourMap::magma, ColourMap::inferno, ColourMap::diverging}) {
        if (name == to_string(map)) return map;
    }
    throw ImageError(fmt::format("unknown colour map '{}'; use viridis, magma, inferno or diverging", name));
}

std::array<float, 3> colour_at(ColourMap map, float t) {
    t = std::clamp(t, 0.0f, 1.0f);
    switch (map) {
        case ColourMap::viridis:
            return interpolate(viridis, t);
        case ColourMap::magma:
            return interpolate(magma, t);
        case ColourMap::inferno:
            return interpolate(inferno, t);
        case ColourMap::diverging:
            return interpolate(diverging, t);
    }
    return colour_of_non_finite;
}

Image apply_colour_map(const Image& scalar, ColourMap map, float low, float high) {
    if (scalar.channels() != 1) {
        throw ImageError(
            fmt::format("a colour map takes one channel, not {}; take a mean or one channel first", scalar.channels()));
    }
    if (!(low < high)) throw ImageError(fmt::format("a colour map needs low < high, not {} and {}", low, high));
    // 1024 steps are four times finer than the 8 bits of a picture.
    std::array<Colour, 1024> table;
    for (std::size_t i = 0; i < table.size(); ++i) {
        table[i] = colour_at(map, static_cast<float>(i) / static_cast<float>(table.size() - 1));
    }
    Image result(scalar.width(), scalar.height(), 3);
    for (std::size_t i = 0; i < scalar.pixel_count(); ++i) {
        const float value = scalar.values()[i];
        const float t = std::clamp((value - low) / (high - low), 0.0f, 1.0f);
        const Colour& colour =
            std::isnan(value) ? colour_of_non_finite
                              : table[static_cast<std::size_t>(std::lround(t * static_cast<float>(table.size() - 1)))];
        std::ranges::copy(colour, result.values().begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return result;
}

Image colour_bar(ColourMap map, int width, int height) {
    Image ramp(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) ramp.at(x, y) = (static_cast<float>(x) + 0.5f) / static_cast<float>(width);
    }
    return apply_colour_map(ramp, map, 0.0f, 1.0f);
}

}  // namespace plumb

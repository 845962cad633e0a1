// Colour maps: scalars made visible.
//
// All colours are display values (sRGB-encoded, 0..1), ready for a PNG; they are not radiance.
//   viridis, magma, inferno  perceptually uniform, dark to bright: the tables of Smith and van der Walt (matplotlib,
//   CC0)
//                            at 33 points, linear between them (within 0.01 of all 256).
//   diverging                blue, white, red, for signed values: Brewer's RdBu with 11 colours (colorbrewer2.org)
//                            reversed, linear between them.
#pragma once

#include <array>
#include <string_view>

#include "frames/image.h"

namespace plumb {

enum class ColourMap { viridis, magma, inferno, diverging };

std::string_view to_string(ColourMap map);
ColourMap colour_map_from_string(std::string_view name);  // throws ImageError that lists the names

// The colour at t in 0..1; t outside is clamped.
std::array<float, 3> colour_at(ColourMap map, float t);

// A value that is no number, in every picture of this program: magenta, which no map contains.
inline constexpr std::array<float, 3> colour_of_non_finite{1.0f, 0.0f, 1.0f};

// Maps a one-channel image: `low` becomes the first colour, `high` the last, values beyond take the nearest of the two
// (infinities too), NaN is magenta. Throws ImageError where the image has more channels or low is not below high.
Image apply_colour_map(const Image& scalar, ColourMap map, float low, float high);

// A bar of the map for legends: first colour left.
Image colour_bar(ColourMap map, int width, int height);

}  // namespace plumb

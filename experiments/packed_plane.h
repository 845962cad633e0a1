// A float plane in as few bytes as its values allow, for pages that contain their images as numbers.
//
// Values are multiplied by a power of two that brings the largest below 32768, and rounded to half floats of 10
// significant bits: each is within 0.1 % as long as it is above 2^-28 of the largest. Infinities and NaN stay what they
// are. Each value's bits are predicted from the pixels left, above and above left (the median edge detector), the
// second and third channel also by what the one before them missed, which takes the noise that channels share; what is
// left is deflated, high bytes first.
//   Source: the predictor is that of LOCO-I, Weinberger, Seroussi, Sapiro 2000; the rest as OpenEXR's ZIP has it.
//
// The text before the first line end says what follows it: "plumbline-plane WIDTH HEIGHT CHANNELS EXPONENT", the
// latter of the power of two that a decoder multiplies by; then comes a zlib stream. experiments/page/planes.js decodes
// it.
#pragma once

#include <string>
#include <string_view>

#include "frames/image.h"

namespace plumb {

// The largest relative difference between a value and what a packed plane gives back.
inline constexpr double packed_plane_precision = 1.0 / 1024;

// Throws ImageError for an image without pixels.
std::string pack_plane(const Image& image);
// Throws ImageError for bytes that are no packed plane, or not all of it.
Image unpack_plane(std::string_view bytes);

}  // namespace plumb

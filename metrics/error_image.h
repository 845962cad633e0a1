// Where two images differ: error images, per channel, of the compared images' shape.
#pragma once

#include "frames/image.h"

namespace plumb {

// Each throws ImageError where shapes differ. A value that is not finite in either image is NaN (magenta in pictures).
Image absolute_error(const Image& test, const Image& reference);     // |v - r|
Image squared_error(const Image& test, const Image& reference);      // (v - r)^2
Image signed_difference(const Image& test, const Image& reference);  // v - r: positive where the image is brighter
// |v - r| / (|r| + 0.01): of the size of the error in pbrt's relative MSE, which puts (r + 0.01)^2 below the square.
Image relative_error(const Image& test, const Image& reference);

// The mean of each pixel's channels, for colour maps; NaN where one of them is.
Image mean_of_channels(const Image& image);

}  // namespace plumb

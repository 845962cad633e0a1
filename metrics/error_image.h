// Where two images differ: error images, per channel, of the compared images' shape.
#pragma once

#include "frames/image.h"

namespace plumb {

// Each throws ImageError where shapes differ. A value that is not finite in either image is NaN (magenta in pictures).
Image absolute_error(const Image& test, const Image& reference);     // |v - r|
Image signed_difference(const Image& test, const Image& reference);  // v - r: positive where the image is brighter

// The mean of each pixel's channels, for colour maps; NaN where one of them is.
Image mean_of_channels(const Image& image);

}  // namespace plumb

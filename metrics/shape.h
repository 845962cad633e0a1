// What must hold before two images can be compared.
#pragma once

#include <string_view>

#include "frames/image.h"

namespace plumb {

// Throws ImageError with both shapes where the two differ in size or channels, or have no pixel. `what` names them in
// the message, such as "plane 'direct'".
void require_same_shape(const Image& test, const Image& reference, std::string_view what = "the images");

// A mask is an image of one channel and the compared images' size; a pixel counts where it is not zero. Throws
// ImageError.
void require_mask_fits(const Image& mask, const Image& image);

inline bool pixel_counts(const Image* mask, int x, int y) { return !mask || mask->at(x, y) != 0.0f; }

}  // namespace plumb

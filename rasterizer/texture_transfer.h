// Images to textures and back. Rows are flipped here and nowhere else: images have their top row first, textures their
// bottom row.
#pragma once

#include "frames/image.h"
#include "rasterizer/gl_objects.h"

namespace plumb {

// Writes `image` to level 0 of one layer (0 for a flat texture). Throws GlError where sizes differ.
void upload(const GlTexture& texture, int layer, const Image& image);

// Reads `channels` floats per texel of one layer and level, without `border` texels on each side. Waits for the GPU.
Image read_back(const GlTexture& texture, int layer, int channels, int border = 0, int level = 0);

}  // namespace plumb

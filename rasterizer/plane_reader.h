// Planes of the GPU as images of a Frame: the right number of channels, the view without its guard band, the top row
// first, normals decoded, zero where nothing is seen.
#pragma once

#include <string>

#include "frames/image.h"
#include "rasterizer/method.h"
#include "rasterizer/plane_textures.h"
#include "scenes/camera.h"

namespace plumb {

// The planes that must be there for read_plane: "depth" for "position", "depth" and "normal" for "normal".
std::vector<std::string> planes_behind(const std::string& plane);

// `view` is the one without guard band.
Image read_plane(const PlaneTextures& planes, const std::string& plane, const View& view, int guard_band,
                 NormalFormat normal_format);

}  // namespace plumb

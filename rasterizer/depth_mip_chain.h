// Depth at several resolutions, so that a tap far away reads a small texture that fits a cache.
//
// A texel of level m is never an average, which would be the depth of nothing, but one pixel of level 0: from each
// level to the next texel (x, y) takes (2x + (y & 1), 2y + (x & 1)), a rotated grid. The two parities only change
// places from step to step, so that m steps append m alternating bits: every level is read straight from level 0, and a
// reader of a texel knows the very pixel that it holds, with its position, normal and radiance.
//   Source: McGuire, Mara, Luebke 2012, "Scalable Ambient Obscurance", whose code forgets about that pixel: it takes
//   the depth of the texel for that of the tap's own position (MipTapPoint::sao2012), and so does the radiosity that
//   Mara et al. ship with G3D.
//   Cost: some hundredths of an ambient obscurance pass with 16 taps, on a software rasteriser. What a far tap reads
//   besides depth (normal, radiance) it reads from level 0, or from chains made in the same way
//   (radiosity.mip_normals_and_radiance).
#pragma once

#include <string_view>

#include "rasterizer/mip_chain_pass.h"

namespace plumb {

constexpr std::string_view depth_mip_chain_plane = "depth_mip_chain";

// Throws MethodError where the points of a stage, "ao" or "radiosity", are to be computed at its taps' own positions
// but positions are stored, which are those of pixels.
void require_points_at_taps(std::string_view stage, bool use_mip_chain, MipTapPoint points, const Method& method);

// One declaration for each layer, 0 and 1. Output: the plane `depth_mip_chain`.
std::vector<PassDeclaration> declare_depth_mip_chain();

}  // namespace plumb

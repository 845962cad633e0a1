// The layers of a frame as one deep OpenEXR file: per pixel a sample for each layer that has a surface there.
//
// Written: one part, deep scan lines, 32-bit float, ZIPS (lossless). Samples go from front to back. Channels:
//
//   Z                   the plane depth of the sample's layer: metres along the camera's -Z
//   R, G, B             the first of the planes total, direct and albedo that every layer has: what compositing
//                       programs show; left away where there is none
//   A                   1: surfaces are opaque. Merging two such files, or flattening one, shows what lies in front
//   normal.X, ...       every plane that all layers have, named as channel_names.h says; in "direct.R" and so on also
//                       the one that R, G and B repeat
//
// Planes that not every layer has (ao, the second layer's light...) have no place in it; they are in the flat file.
//   Source: OpenEXR, "Interpreting OpenEXR Deep Pixels" (point samples: no ZBack).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "frames/frame.h"

namespace plumb {

// Layers are those of the planes "depth", "layer2.depth", "layer3.depth"... The file appears whole or not at all.
// Returns the planes that were left out. Throws ImageError that names the file, or that says which plane is missing.
std::vector<std::string> write_deep_exr(const std::filesystem::path& path, const Frame& frame);

}  // namespace plumb

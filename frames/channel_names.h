// How the planes of a frame are named inside an image file, and which planes the channels of any file make up.
//
// A file knows only flat channels: "direct.R", "direct.G", "direct.B". A viewer (tev, oiiotool, Nuke) takes what stands
// before the last dot as the layer and what stands after it as the channel.
//
//   plane              channels  in the file
//   total              3 or 1    R, G, B or Y: the root, which every viewer shows first
//   alpha              1         A, also of the root
//   depth, *.depth     1         depth.Z
//   any other          1         ao.Y
//   any                2         motion.X, motion.Y
//   normal, position   3         normal.X, .Y, .Z; also layer2.normal and half_a.position
//   any other          3         direct.R, .G, .B
//   any                4         tint.R, .G, .B, .A
//   any                5 on      bins.0, bins.1, ...
//
// Reading back is the inverse, and takes foreign names as well: lower case, U and V, X to W, a root Z (plane "depth"
// where there is none of that name). A channel that fits no such group becomes a plane of one channel under its full
// name.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// Throws ImageError where the file format has no place for it: no name, no channel, `total` or `alpha` of another
// shape.
std::vector<std::string> channel_names(std::string_view plane, int channels);

struct PlaneChannels {
    std::string plane;
    std::vector<std::string> channels;  // full names in the order of the plane's channels
};

std::vector<PlaneChannels> group_channels(std::span<const std::string> names);

}  // namespace plumb

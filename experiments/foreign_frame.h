// Images that another program rendered, with their planes under the names that we use.
//
// Channels group into planes as frames/channel_names.h has it: root R, G, B is `total`, "ao.Y" or "ao.R" is `ao`,
// "indirect.R", .G, .B is `indirect`. Beyond that, names are taken in any case ("AO", "Indirect"), and single names can
// be told: "ViewLayer.DiffInd=indirect".
#pragma once

#include <map>
#include <string>
#include <vector>

#include "frames/frame.h"

namespace plumb {

// "theirs=ours". Throws ConfigError for what is not that.
std::map<std::string, std::string> parse_renamings(const std::vector<std::string>& texts);

// Planes that the path tracer can be the truth of: total, ao, direct, indirect, indirect.K, irradiance, reflection,
// emission.
bool is_light_plane(const std::string& plane);

// The frame's planes under our names. A plane of one channel that comes as three equal ones (ao, depth) becomes one.
// Throws ImageError that names `file` where two planes take the same name, a renaming finds no plane, or the channels
// of ao or depth differ.
Frame with_our_names(Frame frame, const std::map<std::string, std::string>& renamings, const std::string& file);

}  // namespace plumb

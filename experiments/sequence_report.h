// What a comparison of images found, as text for a terminal and as JSON.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "experiments/measured_thing.h"

namespace plumb {

// One row per measure, one column per plane; measures that no plane has are left out. Then, where there are such,
// G-buffers in the same way, and one row per plane and region. Empty for nothing.
std::string print_measures(const std::vector<MeasuredThing>& things);

// One row per frame and plane: error with its 95 % interval, bias, PSNR, SSIM, FLIP, 95th percentile and flicker, as
// far as any frame has them. `whole` ends it, under the name "all".
std::string print_frames(const std::vector<MeasuredFrame>& frames, const std::vector<MeasuredThing>& whole);

// "planes": {plane: {measure: value}}, "regions": {plane: {region: {measure: value}}}, "gbuffer": {layer: {measure:
// value}}. Measures that do not exist are left out; infinities are "inf" and "-inf", which JSON has no number for.
nlohmann::ordered_json json_of(const std::vector<MeasuredThing>& things);
// [{"frame": name, "planes": ...}, ...]
nlohmann::ordered_json json_of(const std::vector<MeasuredFrame>& frames);

}  // namespace plumb

// Heat maps of errors, as PNG files.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "experiments/measured_thing.h"
#include "frames/image.h"

namespace plumb {

// Writes |test - reference|, the mean of the channels, from 0 (black) to `scale` (yellow), NaN magenta. Throws
// ImageError.
void write_error_map(const std::filesystem::path& file, const Image& test, const Image& reference, double scale);

// The error that is shown brightest, for each plane alike in all frames: `fixed` where that is above 0, else just above
// the largest 99th percentile of any frame, or 1 where nothing differs.
std::map<std::string, double> error_map_scales(const std::vector<MeasuredFrame>& frames, double fixed);

// "total: |difference| from 0 (black) to 0.2 (yellow)", one line per plane.
std::string error_map_legend(const std::map<std::string, double>& scales);

}  // namespace plumb

// Heat maps of errors, as PNG files.
#pragma once

#include <filesystem>
#include <string>

#include "frames/image.h"

namespace plumb {

// Writes |test - reference|, the mean of the channels, from 0 (black) to `scale` (yellow), NaN magenta. Throws
// ImageError.
void write_error_map(const std::filesystem::path& file, const Image& test, const Image& reference, double scale);

// A scale for what is measured: just above `error` (a 99th percentile, say), or 1 where nothing differs.
double error_map_scale(double error);

}  // namespace plumb

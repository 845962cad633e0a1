// Heat maps of errors, as PNG files.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/measured_thing.h"
#include "frames/image.h"
#include "metrics/comparison.h"

namespace plumb {

// What a map shows of each pixel: |test - reference|, the mean of the channels; FLIP; or 1 - SSIM, likewise the mean.
enum class ErrorMapKind { difference, flip, ssim };

// "error", "flip", "ssim": as files are called.
std::string_view name_of(ErrorMapKind kind);

// Of `plane`, with the data range, exposures and screen that the comparison has of it; nothing for planes that have no
// such map. Throws ImageError.
std::optional<Image> error_map(ErrorMapKind kind, const Image& test, const Image& reference, std::string_view plane,
                               const ComparisonSettings& settings = {});

// Writes a map from 0 (black) to `scale` (yellow), NaN magenta. Throws ImageError.
void write_error_map(const std::filesystem::path& file, const Image& map, double scale);

// The error that is shown brightest, for each plane alike in all frames: `fixed` where that is above 0, else just above
// the largest 99th percentile of any frame, or 1 where nothing differs.
// FLIP and 1 - SSIM have a scale of 1.
std::map<std::string, double> error_map_scales(const std::vector<MeasuredFrame>& frames, double fixed,
                                               ErrorMapKind kind = ErrorMapKind::difference);

// "total: |difference| from 0 (black) to 0.2 (yellow)", one line per plane.
std::string error_map_legend(const std::map<std::string, double>& scales, ErrorMapKind kind = ErrorMapKind::difference);

}  // namespace plumb

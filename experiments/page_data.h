// What the page's script draws from: a run's results as JSON, and the files that the page contains beside it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/results.h"

namespace plumb {

// Pictures beyond so many bytes are left off the page, and the page says so; a phone opens what is left in seconds.
inline constexpr std::uintmax_t most_picture_bytes = 64'000'000;

struct PageData {
    std::string json;
    // Relative to the results folder. The JSON names them by their places in these lists.
    std::vector<std::string> planes;               // packed planes (packed_plane.h)
    std::vector<std::vector<std::string>> strips;  // JPEG files, one per frame of a camera path
};

// Throws ImageError for a picture whose file or values are missing in `folder`.
PageData page_data(const RunResults& results, const std::filesystem::path& folder);

}  // namespace plumb

// A run's results as one page that needs neither network nor server: table, chart, pictures, error maps.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "experiments/results.h"

namespace plumb {

// The page as HTML; it contains the pictures that lie in `folder`. Throws ImageError for one that cannot be read.
std::string print_page(const RunResults& results, const std::filesystem::path& folder);

std::string escape_html(std::string_view text);
// JSON that may stand within a <script> element: no "</", no "<!--".
std::string escape_for_script(std::string json);

}  // namespace plumb

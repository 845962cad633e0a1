// A run's results as one page that needs neither network nor server: table, charts, pictures, camera paths.
//
// page/page.html is its frame; the files beside it are its style and its script, one concept each. All of them, the
// data (page_data.h) and every picture become part of the one file.
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

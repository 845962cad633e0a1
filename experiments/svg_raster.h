// SVG text as a PNG image, for readers and programs that show no SVG. Drawn by librsvg.
#pragma once

#include <string>
#include <string_view>

namespace plumb {

// The bytes of a PNG file, `scale` pixels to each of the figure's. Throws ImageError where the text is no SVG or the
// image would be too large, with the library's reason.
std::string rasterise_svg(std::string_view svg, double scale = 2.0);

}  // namespace plumb

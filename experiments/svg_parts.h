// What figures written as SVG text share: their head, texts and lines.
#pragma once

#include <string>

namespace plumb {

constexpr const char* svg_ink = "#222222";
constexpr double svg_title_letter_width = 10.0;  // pixels

// Begins a figure of so many pixels, white, with its title at the top; "</svg>" ends it.
std::string open_svg(double width, double height, const std::string& title);

// `anchor`: which end of the text stands at x: start, middle or end. Escapes the content, not the attributes.
std::string svg_text(double x, double y, const std::string& anchor, const std::string& content,
                     const std::string& attributes = "");
std::string svg_line(double x1, double y1, double x2, double y2, const std::string& colour,
                     const std::string& attributes = "");

}  // namespace plumb

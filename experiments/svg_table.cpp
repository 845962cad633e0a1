#include "experiments/svg_table.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "experiments/svg_parts.h"

namespace plumb {
namespace {

// Pixels.
constexpr double head = 44.0, row_height = 20.0, margin = 12.0, gap = 18.0, letter_width = 6.9;

// Characters, of UTF-8 text.
double length_of(const std::string& text) {
    return static_cast<double>(
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }));
}

}  // namespace

std::string print_svg_table(const ResultTable& table, const std::string& title) {
    std::vector<double> widths;
    double width = 2.0 * margin - gap;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        double letters = length_of(table.columns[i]);
        for (const auto& row : table.rows) letters = std::max(letters, length_of(row[i]));
        widths.push_back(letters * letter_width);
        width += widths.back() + gap;
    }
    const double title_width = 2.0 * margin + length_of(title) * svg_title_letter_width;
    const double height = head + static_cast<double>(table.rows.size() + 1) * row_height + margin;
    std::string svg = open_svg(std::max(width, title_width), height, title);

    double y = head + 0.7 * row_height;
    const auto draw_row = [&](const std::vector<std::string>& cells, const std::string& attributes) {
        double x = margin;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const bool is_name = i < table.names;
            svg += svg_text(is_name ? x : x + widths[i], y, is_name ? "start" : "end", cells[i], attributes);
            x += widths[i] + gap;
        }
        y += row_height;
    };
    draw_row(table.columns, "font-weight=\"bold\"");
    svg += svg_line(margin, head + row_height, width - margin, head + row_height, svg_ink);
    for (const auto& row : table.rows) draw_row(row, "");
    return svg + "</svg>\n";
}

}  // namespace plumb

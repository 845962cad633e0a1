#include "experiments/svg_table.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "experiments/svg_parts.h"

namespace plumb {
namespace {

// Pixels.
constexpr double table_head = 44.0, table_row = 20.0, table_margin = 12.0, table_gap = 18.0, table_letter = 6.9;

// Characters, of UTF-8 text.
double length_of(const std::string& text) {
    return static_cast<double>(
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }));
}

}  // namespace

std::string print_svg_table(const ResultTable& table, const std::string& title) {
    std::vector<double> widths;
    double width = 2.0 * table_margin - table_gap;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        double letters = length_of(table.columns[i]);
        for (const auto& row : table.rows) letters = std::max(letters, length_of(row[i]));
        widths.push_back(letters * table_letter);
        width += widths.back() + table_gap;
    }
    const double title_width = 2.0 * table_margin + length_of(title) * svg_title_letter_width;
    const double height = table_head + static_cast<double>(table.rows.size() + 1) * table_row + table_margin;
    std::string svg = open_svg(std::max(width, title_width), height, title);

    double y = table_head + 0.7 * table_row;
    const auto draw_row = [&](const std::vector<std::string>& cells, const std::string& attributes) {
        double x = table_margin;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const bool is_name = i < table.names;
            svg += svg_text(is_name ? x : x + widths[i], y, is_name ? "start" : "end", cells[i], attributes);
            x += widths[i] + table_gap;
        }
        y += table_row;
    };
    draw_row(table.columns, "font-weight=\"bold\"");
    svg += svg_line(table_margin, table_head + table_row, width - table_margin, table_head + table_row, svg_ink);
    for (const auto& row : table.rows) draw_row(row, "");
    return svg + "</svg>\n";
}

}  // namespace plumb

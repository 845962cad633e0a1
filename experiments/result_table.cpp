#include "experiments/result_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/result_files.h"
#include "experiments/terminal_table.h"

namespace plumb {

std::string ResultTable::print_text() const {
    std::vector<TerminalTable::Column> titles;
    for (std::size_t i = 0; i < columns.size(); ++i)
        titles.push_back({columns[i], i < names ? TerminalTable::Align::left : TerminalTable::Align::right});
    TerminalTable table(titles);
    for (const auto& row : rows) table.add_row(row);
    return table.print();
}

std::string ResultTable::print_markdown() const {
    std::string text = "|";
    for (const std::string& column : columns) text += fmt::format(" {} |", escape_markdown_cell(column));
    text += "\n|";
    for (std::size_t i = 0; i < columns.size(); ++i) text += i < names ? "---|" : "---:|";
    text += "\n";
    for (const auto& row : rows) {
        text += "|";
        for (const std::string& cell : row) text += fmt::format(" {} |", escape_markdown_cell(cell));
        text += "\n";
    }
    return text;
}

std::string ResultTable::print_csv() const {
    const auto print_line = [](const std::vector<std::string>& cells) {
        std::vector<std::string> quoted;
        quoted.reserve(cells.size());
        for (const std::string& cell : cells) quoted.push_back(csv_text(cell));
        return fmt::format("{}\n", fmt::join(quoted, ","));
    };
    std::string text = print_line(columns);
    for (const auto& row : rows) text += print_line(row);
    return text;
}

std::string short_number(double value) {
    if (!std::isfinite(value)) return "-";
    if (value != 0.0 && std::abs(value) < 1e-4) return fmt::format("{:.2e}", value);
    return std::abs(value) >= 1000.0 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string escape_markdown_cell(std::string text) {
    for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) text.insert(at, "\\");
    std::ranges::replace(text, '\n', ' ');
    return text;
}

}  // namespace plumb

#include "experiments/terminal_table.h"

#include <algorithm>

namespace plumb {
namespace {

// Characters on the screen, for text whose non-ASCII letters are one column wide each.
std::size_t screen_width(const std::string& text) {
    return static_cast<std::size_t>(std::ranges::count_if(text, [](char byte) { return (byte & 0xC0) != 0x80; }));
}

}  // namespace

std::string TerminalTable::print() const {
    std::vector<std::size_t> widths;
    for (const Column& column : columns_) widths.push_back(screen_width(column.title));
    for (const auto& row : rows_) {
        for (std::size_t i = 0; i < row.size() && i < widths.size(); ++i)
            widths[i] = std::max(widths[i], screen_width(row[i]));
    }
    std::size_t total = 0;
    for (const std::size_t width : widths) total += width + 2;

    std::string text;
    const auto add_line = [&](const std::vector<std::string>& cells) {
        std::string line;
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const std::string cell = i < cells.size() ? cells[i] : "";
            const std::string space(widths[i] - std::min(widths[i], screen_width(cell)), ' ');
            line += columns_[i].align == Align::left ? cell + space : space + cell;
            line += "  ";
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + '\n';
    };
    const std::string rule = std::string(total > 2 ? total - 2 : total, '-') + '\n';
    std::vector<std::string> titles;
    for (const Column& column : columns_) titles.push_back(column.title);
    add_line(titles);
    text += rule;
    for (const auto& row : rows_) row.empty() ? text.append(rule) : (add_line(row), text);
    return text;
}

}  // namespace plumb

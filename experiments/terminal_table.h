// Columns of text, aligned for a terminal.
#pragma once

#include <string>
#include <vector>

namespace plumb {

class TerminalTable {
public:
    enum class Align { left, right };
    struct Column {
        std::string title;
        Align align = Align::left;
    };

    explicit TerminalTable(std::vector<Column> columns) : columns_(std::move(columns)) {}

    // Missing cells at the end of a row are blank.
    void add_row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
    void add_rule() { rows_.emplace_back(); }
    std::string print() const;

private:
    std::vector<Column> columns_;
    std::vector<std::vector<std::string>> rows_;  // an empty row is a rule
};

}  // namespace plumb

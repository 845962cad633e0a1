// A small table of texts that is printed for a terminal, for Markdown and as CSV.
#pragma once

#include <string>
#include <vector>

namespace plumb {

struct ResultTable {
    std::vector<std::string> columns;
    std::size_t names = 1;  // columns from the left that hold names; the others hold numbers and stand to the right
    std::vector<std::vector<std::string>> rows;

    std::string print_text() const;
    std::string print_markdown() const;
    std::string print_csv() const;
};

// Three digits that count; whole where large, an exponent where very small. "-" for what is not finite.
std::string short_number(double value);

// Text that may stand in a cell of a Markdown table.
std::string escape_markdown_cell(std::string text);

}  // namespace plumb

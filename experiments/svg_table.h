// A table as SVG text, for a paper or a slide; needs nothing but itself.
#pragma once

#include <string>

#include "experiments/result_table.h"

namespace plumb {

std::string print_svg_table(const ResultTable& table, const std::string& title);

}  // namespace plumb

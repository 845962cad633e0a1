// Figures and tables made of cells, as the tables [[figures]] and [[originals]] of an experiment's file say
// (presentation.h).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/presentation.h"
#include "experiments/result_table.h"

namespace plumb {

// Curves or bars. A point is the mean over the cells that fall together: geometric where the axis is logarithmic. With
// `relative_to` it is the geometric mean of ratios, with its 95 % interval as a bar. Empty where no cell has the
// measure.
std::string print_chart(const Figure& figure, const std::vector<Cell>& cells);
// The points of such a chart as numbers.
ResultTable chart_numbers(const Figure& figure, const std::vector<Cell>& cells);

// One row for each combination of the figure's attributes, arithmetic means over the rest: over those views and paths
// that all rows have which differ in nothing but the method; "0.1 (4 of 5)" where that leaves some out.
ResultTable make_table(const Figure& figure, const std::vector<Cell>& cells);

// A seed's numbers beside ours, both also as ratios to the base row; ours are geometric means over views, their ratios
// with intervals where the rows share views.
ResultTable make_originals_table(const Originals& originals, const std::vector<Cell>& cells);

// The pictures of views side by side, as SVG that contains them; files lie in `folder`. One row per view, plane and
// truth, one column per label. Empty where nothing fits. Throws ImageError for a file that cannot be read.
std::string print_picture_sheet(const Figure& figure, const std::vector<PictureSet>& pictures,
                                const std::filesystem::path& folder);
// What was measured of the pictures of such a sheet: one row for each but the truth's, in the order of the sheet, with
// the error that its error map shows in the last colour. Empty texts where a picture has no cell or the cell no value.
ResultTable picture_numbers(const Figure& figure, const std::vector<PictureSet>& pictures,
                            const std::vector<Cell>& cells);

}  // namespace plumb

// Charts with two logarithmic axes as SVG text: several side by side in one figure. Needs nothing but itself, so that
// it stands in a paper, a README or a page as it is.
#pragma once

#include <string>
#include <vector>

namespace plumb {

struct ChartPoint {
    double x = 1.0, y = 1.0;          // positive
    double lower = 0.0, upper = 0.0;  // of a bar through the point; equal: none
};

struct ChartSeries {
    std::string name;  // in the legend; empty: not there
    std::string colour = "#0072b2";
    std::vector<ChartPoint> points;
    enum class Style { markers, line, dashed_line, markers_and_line } style = Style::markers_and_line;
    enum class Marker { circle, square, triangle } marker = Marker::circle;
};

struct Chart {
    std::string title, x_label, y_label;
    std::vector<ChartSeries> series;
};

// Where a logarithmic axis from `least` to `greatest` has its labels: 1, 2, 5, 10, 20..., or powers of ten alone where
// those would be many.
std::vector<double> logarithmic_ticks(double least, double greatest);

// Charts in rows of `columns`. Points that are not positive and finite are left out. `note` stands below them, one
// line.
std::string print_svg(const std::vector<Chart>& charts, int columns, const std::string& title,
                      const std::string& note = "");

}  // namespace plumb

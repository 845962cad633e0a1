// Charts as SVG text: curves over logarithmic or linear axes, bars in groups, waterfalls; several side by side in one
// figure. Needs nothing but itself, so that it stands in a paper, a README or a page as it is.
#pragma once

#include <string>
#include <vector>

namespace plumb {

struct ChartPoint {
    double x = 1.0, y = 1.0;          // on a logarithmic axis: positive
    double lower = 0.0, upper = 0.0;  // of an error bar through the point; equal: none
    double base = 0.0;                // where a bar begins; waterfalls float
};

struct ChartSeries {
    std::string name;  // in the legend; empty: not there
    std::string colour = "#0072b2";
    std::vector<ChartPoint> points;
    // Bars stand at the category whose index is their x; those of several series stand side by side, unless the chart
    // is a waterfall.
    enum class Style { markers, line, dashed_line, markers_and_line, bars } style = Style::markers_and_line;
    enum class Marker { circle, square, triangle } marker = Marker::circle;
    std::vector<std::string> labels = {};  // beside the points, above or below the bars, in their order
};

enum class ChartScale { logarithmic, linear };

struct Chart {
    std::string title, x_label, y_label;
    std::vector<ChartSeries> series;
    ChartScale x_scale = ChartScale::logarithmic, y_scale = ChartScale::logarithmic;
    std::vector<std::string> categories = {};  // not empty: the x axis names these instead of numbers
    bool is_waterfall = false;                 // bars stand in each other's place, joined by thin lines
};

// Colours that can be told apart with colour-blind eyes too (Okabe and Ito 2008), over and over.
std::string chart_colour(std::size_t index);

// Where a logarithmic axis from `least` to `greatest` has its labels: 1, 2, 5, 10, 20..., powers of ten alone where
// those would be many, those of a linear axis where they would be fewer than three.
std::vector<double> logarithmic_ticks(double least, double greatest);
// The same of a linear axis: multiples of 1, 2 or 5 times a power of ten, at most seven of them.
std::vector<double> linear_ticks(double least, double greatest);

// Charts in rows of `columns`. Points that cannot be drawn (not finite, or not positive on a logarithmic axis) are left
// out. `note` stands below them, one line. Legends stand in the corner with the fewest points.
std::string print_svg(const std::vector<Chart>& charts, int columns, const std::string& title,
                      const std::string& note = "");

}  // namespace plumb

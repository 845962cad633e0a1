// Charts, as far as their SVG text tells where things lie.
#include "experiments/svg_chart.h"

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

struct Rectangle {
    double x, y, width, height;
};

std::vector<Rectangle> rectangles(const std::string& svg, const std::string& colour) {
    const std::regex pattern(
        "<rect x=\"([-0-9.]+)\" y=\"([-0-9.]+)\" width=\"([-0-9.]+)\" height=\"([-0-9.]+)\" fill=\"" + colour + "\"");
    std::vector<Rectangle> found;
    for (std::sregex_iterator match(svg.begin(), svg.end(), pattern); match != std::sregex_iterator(); ++match) {
        const auto number = [&](std::size_t group) { return std::stod((*match)[group].str()); };
        found.push_back({number(1), number(2), number(3), number(4)});
    }
    return found;
}

Chart bars_of_equal_height(ChartScale y_scale) {
    Chart chart;
    chart.y_scale = y_scale;
    chart.categories = {"one", "two", "three"};
    for (const char* colour : {"#111111", "#222222", "#333333", "#444444"}) {
        ChartSeries series{std::string("a series of ") + colour, colour, {}, ChartSeries::Style::bars};
        for (int i = 0; i < 3; ++i) series.points.push_back({static_cast<double>(i), 1.0, 0.9, 1.2});
        chart.series.push_back(series);
    }
    return chart;
}

TEST(SvgChart, LegendsStandAboveBarsThatFillThePanel) {
    for (const ChartScale scale : {ChartScale::linear, ChartScale::logarithmic}) {
        const Chart chart = bars_of_equal_height(scale);
        const std::string svg = print_svg({chart}, 1, "Bars", "");
        double highest_bar = 1e9, lowest_mark = 0.0;
        for (const ChartSeries& series : chart.series) {
            const std::vector<Rectangle> found = rectangles(svg, series.colour);
            ASSERT_EQ(found.size(), 4u) << svg;  // three bars, then the legend's mark
            for (std::size_t i = 0; i < 3; ++i) highest_bar = std::min(highest_bar, found[i].y);
            lowest_mark = std::max(lowest_mark, found[3].y + found[3].height);
        }
        EXPECT_LT(lowest_mark, highest_bar) << svg;
    }
}

}  // namespace
}  // namespace plumb

#include "experiments/svg_chart.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "experiments/page.h"

namespace plumb {
namespace {

// Pixels.
constexpr double panel_width = 330.0, panel_height = 270.0;
constexpr double left = 64.0, right = 14.0, top = 30.0, bottom = 46.0;
constexpr double head = 40.0, foot = 28.0;
constexpr const char *ink = "#222222", *faint = "#dddddd";

bool drawable(const ChartPoint& point) {
    return point.x > 0.0 && point.y > 0.0 && std::isfinite(point.x) && std::isfinite(point.y);
}

struct Axis {
    double least = std::numeric_limits<double>::infinity(), greatest = 0.0;  // values
    double from = 0.0, to = 1.0;                                             // pixels

    void include(double value) { least = std::min(least, value), greatest = std::max(greatest, value); }
    void widen() {
        if (!(least < std::numeric_limits<double>::infinity())) least = 1.0, greatest = 10.0;
        const double margin = std::max(1.05, std::pow(greatest / least, 0.04));
        least /= margin, greatest *= margin;
    }
    double place(double value) const {
        return std::lerp(from, to, std::log(value / least) / std::log(greatest / least));
    }
};

std::string text(double x, double y, const std::string& anchor, const std::string& content,
                 const std::string& attributes = "") {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor,
                       attributes.empty() ? "" : " " + attributes, escape_html(content));
}

std::string line(double x1, double y1, double x2, double y2, const std::string& colour,
                 const std::string& attributes = "") {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"{}/>\n", x1, y1, x2,
                       y2, colour, attributes.empty() ? "" : " " + attributes);
}

std::string marker(ChartSeries::Marker kind, double x, double y, const std::string& colour) {
    switch (kind) {
        case ChartSeries::Marker::square:
            return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"6\" height=\"6\" fill=\"{}\"/>\n", x - 3, y - 3,
                               colour);
        case ChartSeries::Marker::triangle:
            return fmt::format("<path d=\"M{:.1f} {:.1f} l4 7 h-8 z\" fill=\"{}\"/>\n", x, y - 4, colour);
        default:
            return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.2\" fill=\"{}\"/>\n", x, y, colour);
    }
}

bool has_line(const ChartSeries& series) { return series.style != ChartSeries::Style::markers; }
bool has_markers(const ChartSeries& series) {
    return series.style == ChartSeries::Style::markers || series.style == ChartSeries::Style::markers_and_line;
}
std::string dashes(const ChartSeries& series) {
    return series.style == ChartSeries::Style::dashed_line ? "stroke-dasharray=\"4 3\"" : "";
}

std::string draw_axes(const Chart& chart, const Axis& x, const Axis& y) {
    std::string svg;
    for (const double tick : logarithmic_ticks(x.least, x.greatest)) {
        svg += line(x.place(tick), y.from, x.place(tick), y.to, faint);
        svg += text(x.place(tick), y.from + 14.0, "middle", fmt::format("{:g}", tick));
    }
    for (const double tick : logarithmic_ticks(y.least, y.greatest)) {
        svg += line(x.from, y.place(tick), x.to, y.place(tick), faint);
        svg += text(x.from - 5.0, y.place(tick) + 4.0, "end", fmt::format("{:g}", tick));
    }
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" stroke=\"{}\"/>\n", x.from,
        y.to, x.to - x.from, y.from - y.to, ink);
    const double middle_x = 0.5 * (x.from + x.to), middle_y = 0.5 * (y.from + y.to);
    svg += text(middle_x, y.to - 9.0, "middle", chart.title, "font-weight=\"bold\"");
    svg += text(middle_x, y.from + 32.0, "middle", chart.x_label);
    svg += text(x.from - 51.0, middle_y, "middle", chart.y_label,
                fmt::format("transform=\"rotate(-90 {:.1f} {:.1f})\"", x.from - 51.0, middle_y));
    return svg;
}

std::string draw_series(const ChartSeries& series, const Axis& x, const Axis& y) {
    std::string svg, path, bars, markers;
    for (const ChartPoint& point : series.points) {
        if (!drawable(point)) continue;
        const double at_x = x.place(point.x), at_y = y.place(point.y);
        path += fmt::format("{}{:.1f} {:.1f} ", path.empty() ? "M" : "L", at_x, at_y);
        if (point.lower > 0.0 && point.upper > point.lower)
            bars += line(at_x, y.place(point.lower), at_x, y.place(point.upper), series.colour);
        if (has_markers(series)) markers += marker(series.marker, at_x, at_y, series.colour);
    }
    if (has_line(series) && !path.empty()) {
        path.pop_back();
        svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.3\" {}/>\n", path,
                           series.colour, dashes(series));
    }
    return svg + bars + markers;
}

// In the upper right corner: curves of errors fall.
std::string draw_legend(const Chart& chart, const Axis& x, const Axis& y) {
    std::string svg;
    double at_y = y.to + 16.0;
    for (const ChartSeries& series : chart.series) {
        if (series.name.empty()) continue;
        if (has_line(series))
            svg += line(x.to - 26.0, at_y - 4.0, x.to - 8.0, at_y - 4.0, series.colour, dashes(series));
        if (has_markers(series)) svg += marker(series.marker, x.to - 17.0, at_y - 4.0, series.colour);
        svg += text(x.to - 31.0, at_y, "end", series.name);
        at_y += 15.0;
    }
    return svg;
}

std::string draw_chart(const Chart& chart, double origin_x, double origin_y) {
    Axis x, y;
    for (const ChartSeries& series : chart.series) {
        for (const ChartPoint& point : series.points) {
            if (!drawable(point)) continue;
            x.include(point.x), y.include(point.y);
            if (point.lower > 0.0 && point.upper > point.lower) y.include(point.lower), y.include(point.upper);
        }
    }
    x.widen(), y.widen();
    x.from = origin_x + left, x.to = origin_x + panel_width - right;
    y.from = origin_y + panel_height - bottom, y.to = origin_y + top;
    std::string svg = "<g>\n" + draw_axes(chart, x, y);
    for (const ChartSeries& series : chart.series) svg += draw_series(series, x, y);
    return svg + draw_legend(chart, x, y) + "</g>\n";
}

}  // namespace

std::vector<double> logarithmic_ticks(double least, double greatest) {
    const double decades = std::log10(greatest / least);
    const std::vector<double> steps = decades > 2.6 ? std::vector<double>{1.0} : std::vector<double>{1.0, 2.0, 5.0};
    std::vector<double> ticks;
    for (double power = std::floor(std::log10(least)); power <= std::ceil(std::log10(greatest)); power += 1.0) {
        for (const double step : steps) {
            const double tick = step * std::pow(10.0, power);
            if (tick >= least && tick <= greatest) ticks.push_back(tick);
        }
    }
    return ticks;
}

std::string print_svg(const std::vector<Chart>& charts, int columns, const std::string& title,
                      const std::string& note) {
    const int rows = (static_cast<int>(charts.size()) + columns - 1) / columns;
    const double width = columns * panel_width, height = head + rows * panel_height + (note.empty() ? 8.0 : foot);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
        "{1:.0f}\" font-family=\"DejaVu Sans, Helvetica, sans-serif\" font-size=\"11\" fill=\"{2}\" role=\"img\">\n"
        "<title>{3}</title>\n<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n",
        width, height, ink, escape_html(title));
    svg += text(0.5 * width, 25.0, "middle", title, "font-size=\"16\" font-weight=\"bold\"");
    for (std::size_t i = 0; i < charts.size(); ++i) {
        const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
        svg += draw_chart(charts[i], column * panel_width, head + row * panel_height);
    }
    if (!note.empty()) svg += text(0.5 * width, height - 10.0, "middle", note);
    return svg + "</svg>\n";
}

}  // namespace plumb

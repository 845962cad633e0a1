#include "experiments/svg_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "experiments/svg_parts.h"

namespace plumb {
namespace {

// Pixels.
constexpr double panel_width = 330.0, panel_height = 270.0;
constexpr double left = 64.0, right = 14.0, top = 30.0, bottom = 46.0;
constexpr double head = 40.0, foot = 28.0;
constexpr double legend_line = 15.0, letter_width = 6.3;
constexpr double slant_height = 46.0;  // more for names of categories that stand aslant
constexpr double slant_degrees = 25.0;
constexpr double label_letter_width = 5.2, label_height = 9.0;
constexpr const char* faint = "#dddddd";

struct Axis {
    bool logarithmic = true;
    double least = std::numeric_limits<double>::infinity(), greatest = -least;  // values
    double from = 0.0, to = 1.0;                                                // pixels

    bool can_show(double value) const { return std::isfinite(value) && (!logarithmic || value > 0.0); }
    void include(double value) {
        if (can_show(value)) least = std::min(least, value), greatest = std::max(greatest, value);
    }
    void widen() {
        if (!(least <= greatest)) least = 1.0, greatest = 10.0;
        if (logarithmic) {
            const double margin = std::max(1.05, std::pow(greatest / least, 0.04));
            least /= margin, greatest *= margin;
        } else {
            const double margin = greatest > least ? 0.05 * (greatest - least) : std::max(0.5, 0.1 * std::abs(least));
            // An axis that begins at nothing stays there.
            if (least != 0.0) least -= margin;
            if (greatest != 0.0) greatest += margin;
        }
    }
    // As many times as long, to the greater side.
    void leave_room_above(double factor) {
        greatest = logarithmic ? least * std::pow(greatest / least, factor) : least + factor * (greatest - least);
    }
    double place(double value) const {
        const double share =
            logarithmic ? std::log(value / least) / std::log(greatest / least) : (value - least) / (greatest - least);
        return std::lerp(from, to, share);
    }
    std::vector<double> ticks() const {
        return logarithmic ? logarithmic_ticks(least, greatest) : linear_ticks(least, greatest);
    }
};

std::string rectangle(double x, double y, double width, double height, const std::string& fill) {
    return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n", x, y,
                       width, height, fill);
}

std::string marker(ChartSeries::Marker kind, double x, double y, const std::string& colour) {
    switch (kind) {
        case ChartSeries::Marker::square:
            return rectangle(x - 3, y - 3, 6, 6, colour);
        case ChartSeries::Marker::triangle:
            return fmt::format("<path d=\"M{:.1f} {:.1f} l4 7 h-8 z\" fill=\"{}\"/>\n", x, y - 4, colour);
        case ChartSeries::Marker::circle:
            break;
    }
    return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.2\" fill=\"{}\"/>\n", x, y, colour);
}

bool is_bars(const ChartSeries& series) { return series.style == ChartSeries::Style::bars; }
bool has_line(const ChartSeries& series) { return series.style != ChartSeries::Style::markers && !is_bars(series); }
bool has_markers(const ChartSeries& series) {
    return series.style == ChartSeries::Style::markers || series.style == ChartSeries::Style::markers_and_line;
}
std::string dashes(const ChartSeries& series) {
    return series.style == ChartSeries::Style::dashed_line ? "stroke-dasharray=\"4 3\"" : "";
}

// Names of categories that would run into each other.
bool has_slanted_categories(const Chart& chart) {
    const double room = (panel_width - left - right) / std::max(1.0, static_cast<double>(chart.categories.size()));
    return std::ranges::any_of(chart.categories, [&](const std::string& name) {
        return static_cast<double>(name.size()) * letter_width > room;
    });
}

// By how much slanted names reach out of their panel to the left.
double overhang(const Chart& chart) {
    if (!has_slanted_categories(chart)) return 0.0;
    const double room = (panel_width - left - right) / static_cast<double>(chart.categories.size());
    const double advance = letter_width * std::cos(glm::radians(slant_degrees));  // from letter to letter, to the side
    double most = 0.0;
    for (std::size_t i = 0; i < chart.categories.size(); ++i) {
        const double end = left + (static_cast<double>(i) + 0.5) * room;
        most = std::max(most, advance * static_cast<double>(chart.categories[i].size()) - end);
    }
    return most;
}

// One panel being drawn: the chart, its axes, and how much room its bars have.
class Panel {
public:
    Panel(const Chart& chart, double origin_x, double origin_y) : chart_(chart) {
        x_.logarithmic = chart.categories.empty() && chart.x_scale == ChartScale::logarithmic;
        y_.logarithmic = chart.y_scale == ChartScale::logarithmic;
        for (const ChartSeries& series : chart.series) {
            for (const ChartPoint& point : series.points) include(series, point);
        }
        if (chart.categories.empty()) {
            x_.widen();
        } else {
            x_.least = -0.5, x_.greatest = static_cast<double>(chart.categories.size()) - 0.5;
        }
        y_.widen();
        x_.from = origin_x + left, x_.to = origin_x + panel_width - right;
        y_.from = origin_y + panel_height - bottom, y_.to = origin_y + top;
        // Bars fill the panel from the foot on: where none of its corners is free, they leave room above them.
        const LegendSize legend = legend_size();
        if (std::ranges::any_of(chart.series, is_bars) && points_under(legend_corner(legend), legend) > 0) {
            const double height = y_.from - y_.to;
            y_.leave_room_above(height / std::max(0.3 * height, height - legend.height));
        }
    }

    std::string draw() const {
        std::string svg = "<g>\n" + draw_axes();
        const auto bars = std::ranges::count_if(chart_.series, is_bars);
        int bar = 0;
        for (const ChartSeries& series : chart_.series) {
            svg += is_bars(series) ? draw_bars(series, bar, static_cast<int>(bars)) : draw_points(series);
            bar += is_bars(series) ? 1 : 0;
        }
        return svg + draw_legend() + "</g>\n";
    }

private:
    bool can_show(const ChartPoint& point) const { return x_.can_show(point.x) && y_.can_show(point.y); }
    bool has_error_bar(const ChartPoint& point) const {
        return point.upper > point.lower && y_.can_show(point.lower) && y_.can_show(point.upper);
    }

    void include(const ChartSeries& series, const ChartPoint& point) {
        if (!can_show(point)) return;
        x_.include(point.x), y_.include(point.y);
        if (is_bars(series)) y_.include(point.base);
        if (has_error_bar(point)) y_.include(point.lower), y_.include(point.upper);
    }

    std::string draw_axes() const {
        std::string svg;
        if (chart_.categories.empty()) {
            double free_from = -1e9;  // where the number before ends
            for (const double tick : x_.ticks()) {
                const std::string number = fmt::format("{:g}", tick);
                // A digit is as wide as some 6 pixels; numbers that would run into each other are left out.
                const double half_width = 3.0 * static_cast<double>(number.size()) + 2.0;
                svg += svg_line(x_.place(tick), y_.from, x_.place(tick), y_.to, faint);
                if (x_.place(tick) - half_width < free_from) continue;
                svg += svg_text(x_.place(tick), y_.from + 14.0, "middle", number);
                free_from = x_.place(tick) + half_width;
            }
        } else {
            svg += draw_categories();
        }
        for (const double tick : y_.ticks()) {
            svg += svg_line(x_.from, y_.place(tick), x_.to, y_.place(tick), faint);
            svg += svg_text(x_.from - 5.0, y_.place(tick) + 4.0, "end", fmt::format("{:g}", tick));
        }
        svg += fmt::format(
            "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" stroke=\"{}\"/>\n",
            x_.from, y_.to, x_.to - x_.from, y_.from - y_.to, svg_ink);
        const double middle_x = 0.5 * (x_.from + x_.to), middle_y = 0.5 * (y_.from + y_.to);
        svg += svg_text(middle_x, y_.to - 9.0, "middle", chart_.title, "font-weight=\"bold\"");
        if (!chart_.x_label.empty()) svg += svg_text(middle_x, y_.from + 32.0, "middle", chart_.x_label);
        svg += svg_text(x_.from - 51.0, middle_y, "middle", chart_.y_label,
                        fmt::format("transform=\"rotate(-90 {:.1f} {:.1f})\"", x_.from - 51.0, middle_y));
        return svg;
    }

    std::string draw_categories() const {
        const bool aslant = has_slanted_categories(chart_);
        std::string svg;
        for (std::size_t i = 0; i < chart_.categories.size(); ++i) {
            const double x = x_.place(static_cast<double>(i)), y = y_.from + (aslant ? 11.0 : 14.0);
            svg += aslant ? svg_text(x + 4.0, y, "end", chart_.categories[i],
                                     fmt::format("transform=\"rotate({} {:.1f} {:.1f})\"", -slant_degrees, x + 4.0, y))
                          : svg_text(x, y, "middle", chart_.categories[i]);
        }
        return svg;
    }

    std::string draw_points(const ChartSeries& series) const {
        std::string svg, path, bars, markers;
        for (std::size_t i = 0; i < series.points.size(); ++i) {
            const ChartPoint& point = series.points[i];
            if (!can_show(point)) continue;
            const double at_x = x_.place(point.x), at_y = y_.place(point.y);
            path += fmt::format("{}{:.1f} {:.1f} ", path.empty() ? "M" : "L", at_x, at_y);
            if (has_error_bar(point))
                bars += svg_line(at_x, y_.place(point.lower), at_x, y_.place(point.upper), series.colour);
            if (has_markers(series)) markers += marker(series.marker, at_x, at_y, series.colour);
            if (i < series.labels.size()) markers += draw_label(series.labels[i], at_x, at_y);
        }
        if (has_line(series) && !path.empty()) {
            path.pop_back();
            svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.3\" {}/>\n", path,
                               series.colour, dashes(series));
        }
        return svg + bars + markers;
    }

    // Towards the middle, so that it stays within the frame.
    std::string draw_label(const std::string& label, double x, double y) const {
        const bool to_the_left = x > 0.5 * (x_.from + x_.to);
        return svg_text(x + (to_the_left ? -6.0 : 6.0), y - 4.0, to_the_left ? "end" : "start", label,
                        fmt::format("font-size=\"{}\"", label_height));
    }

    double category_width() const {
        return (x_.to - x_.from) / static_cast<double>(std::max<std::size_t>(1, chart_.categories.size()));
    }

    std::string draw_bars(const ChartSeries& series, int index, int count) const {
        const double room = category_width();
        const int places = chart_.is_waterfall ? 1 : count;
        const double width = 0.8 * room / places;
        std::string svg;
        for (std::size_t i = 0; i < series.points.size(); ++i) {
            const ChartPoint& point = series.points[i];
            if (!can_show(point)) continue;
            const double offset = chart_.is_waterfall ? 0.0 : (index - 0.5 * (places - 1)) * width;
            const double middle = x_.place(point.x) + offset;
            const double base = y_.can_show(point.base) ? y_.place(point.base) : y_.from, end = y_.place(point.y);
            svg += rectangle(middle - 0.46 * width, std::min(base, end), 0.92 * width, std::abs(base - end),
                             series.colour);
            if (has_error_bar(point))
                svg += svg_line(middle, y_.place(point.lower), middle, y_.place(point.upper), svg_ink);
            // To the next bar, which begins where this one ends.
            if (chart_.is_waterfall && middle + room < x_.to)
                svg += svg_line(middle + 0.4 * room, end, middle + 0.6 * room, end, svg_ink, "stroke-width=\"0.7\"");
            if (i < series.labels.size() && !series.labels[i].empty())
                svg += draw_bar_label(series.labels[i], point, middle, std::max(base, end));
        }
        return svg;
    }

    // Upwards, below the bar if it floats high enough, else above it.
    std::string draw_bar_label(const std::string& label, const ChartPoint& point, double middle,
                               double lower_end) const {
        constexpr double gap = 4.0;
        const double low = has_error_bar(point) ? std::max(lower_end, y_.place(point.lower)) : lower_end;
        const double x = middle + 0.35 * label_height;
        const bool below = low + gap + label_letter_width * static_cast<double>(label.size()) < y_.from;
        double high = std::min(y_.place(point.y), lower_end);
        if (has_error_bar(point)) high = std::min(high, y_.place(point.upper));
        const double y = below ? low + gap : high - gap;
        return svg_text(x, y, below ? "end" : "start", label,
                        fmt::format("font-size=\"{}\" transform=\"rotate(-90 {:.1f} {:.1f})\"", label_height, x, y));
    }

    struct Corner {
        bool at_left, at_bottom;
    };

    struct LegendSize {
        double width, height;
        int lines;
    };

    LegendSize legend_size() const {
        std::size_t longest = 0;
        int lines = 0;
        for (const ChartSeries& series : chart_.series) {
            longest = std::max(longest, series.name.size());
            lines += series.name.empty() ? 0 : 1;
        }
        return {31.0 + static_cast<double>(longest) * letter_width, lines == 0 ? 0.0 : 8.0 + lines * legend_line,
                lines};
    }

    int points_under(const Corner& corner, const LegendSize& legend) const {
        int count = 0;
        for (const ChartSeries& series : chart_.series) {
            for (const ChartPoint& point : series.points) {
                if (!can_show(point)) continue;
                const double x = x_.place(point.x);
                const double y = y_.place(is_bars(series) && has_error_bar(point) ? point.upper : point.y);
                const double reach = is_bars(series) ? 0.4 * category_width() : 0.0;
                const bool beside =
                    corner.at_left ? x - reach > x_.from + legend.width : x + reach < x_.to - legend.width;
                // A bar covers all from its end to its foot.
                const bool apart =
                    corner.at_bottom ? y < y_.from - legend.height && !is_bars(series) : y > y_.to + legend.height;
                count += beside || apart ? 0 : 1;
            }
        }
        return count;
    }

    // Of the four, the one whose area the fewest points and bars lie in; the upper right one where it is as good.
    Corner legend_corner(const LegendSize& legend) const {
        constexpr std::array<Corner, 4> corners = {Corner{false, false}, {true, false}, {false, true}, {true, true}};
        return *std::ranges::min_element(corners, {},
                                         [&](const Corner& corner) { return points_under(corner, legend); });
    }

    std::string draw_legend() const {
        const LegendSize legend = legend_size();
        const Corner corner = legend_corner(legend);
        const double side = corner.at_left ? 1.0 : -1.0, edge = corner.at_left ? x_.from : x_.to;
        double y = corner.at_bottom ? y_.from - 8.0 - (legend.lines - 1) * legend_line : y_.to + 16.0;
        std::string svg;
        for (const ChartSeries& series : chart_.series) {
            if (series.name.empty()) continue;
            if (has_line(series))
                svg += svg_line(edge + side * 26.0, y - 4.0, edge + side * 8.0, y - 4.0, series.colour, dashes(series));
            if (has_markers(series)) svg += marker(series.marker, edge + side * 17.0, y - 4.0, series.colour);
            if (is_bars(series)) svg += rectangle(edge + side * 17.0 - 5.0, y - 9.0, 10.0, 10.0, series.colour);
            svg += svg_text(edge + side * 31.0, y, corner.at_left ? "start" : "end", series.name);
            y += legend_line;
        }
        return svg;
    }

    const Chart& chart_;
    Axis x_, y_;
};

}  // namespace

std::string chart_colour(std::size_t index) {
    constexpr std::array colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
    return colours[index % colours.size()];
}

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
    constexpr std::size_t fewest = 3;  // else nobody could read a value off the axis
    return ticks.size() >= fewest ? ticks : linear_ticks(least, greatest);
}

std::vector<double> linear_ticks(double least, double greatest) {
    constexpr double most_steps = 6.0;
    const double rough = (greatest - least) / most_steps, power = std::pow(10.0, std::floor(std::log10(rough)));
    double step = 10.0 * power;
    for (const double candidate : {5.0 * power, 2.0 * power, power}) {
        if (candidate >= rough) step = candidate;
    }
    std::vector<double> ticks;
    // Whole numbers of steps, so that nothing adds up and zero is zero.
    for (double i = std::ceil(least / step - 1e-9); i * step <= greatest + 1e-9 * step; i += 1.0)
        ticks.push_back(i * step + 0.0);
    return ticks;
}

std::string print_svg(const std::vector<Chart>& charts, int columns, const std::string& title,
                      const std::string& note) {
    const int rows = (static_cast<int>(charts.size()) + columns - 1) / columns;
    const double row_height = panel_height + (std::ranges::any_of(charts, has_slanted_categories) ? slant_height : 0.0);
    double margin = 0.0;
    for (const Chart& chart : charts) margin = std::max(margin, overhang(chart));
    const double panels_width = margin + columns * panel_width;
    const double width = std::max({panels_width, 20.0 + static_cast<double>(title.size()) * svg_title_letter_width,
                                   20.0 + static_cast<double>(note.size()) * letter_width});
    const double height = head + rows * row_height + (note.empty() ? 8.0 : foot);
    std::string svg = open_svg(width, height, title);
    for (std::size_t i = 0; i < charts.size(); ++i) {
        const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
        svg += Panel(charts[i], 0.5 * (width - panels_width) + margin + column * panel_width, head + row * row_height)
                   .draw();
    }
    if (!note.empty()) svg += svg_text(0.5 * width, height - 10.0, "middle", note);
    return svg + "</svg>\n";
}

}  // namespace plumb

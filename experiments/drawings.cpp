#include "experiments/drawings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "experiments/svg_chart.h"
#include "experiments/svg_parts.h"
#include "rasterizer/sample_spiral.h"

namespace plumb {
namespace {

SpiralDrawing read_spiral(ConfigReader& reader) {
    SpiralDrawing spiral;
    spiral.samples = reader.integer("samples", spiral.samples, 1, maximum_spiral_samples);
    spiral.turns = reader.integer("turns", spiral.turns, 0, 100000);
    spiral.spin = reader.number("spin", spiral.spin, -1.0, 1.0);
    reader.finish();
    if (spiral.turns == 0) spiral.turns = spiral_turns(spiral.samples);
    return spiral;
}

Drawing read_drawing(ConfigReader& reader) {
    Drawing drawing;
    drawing.title = reader.required_text("title");
    drawing.source = reader.required_text("source");
    const std::string kind = reader.required_text("drawing");
    if (kind == "spiral") {
        for (ConfigReader& spiral : reader.tables("spirals")) drawing.spirals.push_back(read_spiral(spiral));
        if (drawing.spirals.empty()) reader.fail("", "'spirals' is missing: write at least one");
    } else if (kind == "filter") {
        drawing.kind = Drawing::Kind::filter;
        drawing.size = reader.integer("size", drawing.size, 3, 101);
        drawing.radius = reader.integer("radius", drawing.radius, 1, 50);
        if (drawing.size % 2 == 0)
            reader.fail("size", fmt::format("is {}, but must be odd to have a middle", drawing.size));
    } else {
        reader.fail("drawing", fmt::format("no drawing '{}'; {}", kind, name_hint(kind, {"spiral", "filter"})));
    }
    reader.finish();
    return drawing;
}

struct Tap {
    double x = 0.0, y = 0.0;  // in radii of the spiral
};

// The point at the fraction `along` of the spiral: as far out as along it.
Tap spiral_point(const SpiralDrawing& spiral, double along) {
    const double angle = 2.0 * std::numbers::pi * (along * spiral.turns + spiral.spin);
    return {along * std::cos(angle), along * std::sin(angle)};
}

// Taps lie in the middle of their share of the spiral (sample_spiral.h, a jitter of one half).
std::vector<Tap> taps_of(const SpiralDrawing& spiral) {
    std::vector<Tap> taps;
    taps.reserve(static_cast<std::size_t>(spiral.samples));
    for (int i = 0; i < spiral.samples; ++i) taps.push_back(spiral_point(spiral, (i + 0.5) / spiral.samples));
    return taps;
}

std::string spiral_title(const SpiralDrawing& spiral) {
    return fmt::format("{} taps, {} turns{}", spiral.samples, spiral.turns,
                       spiral.spin == 0.0 ? "" : fmt::format(", spun by {:g}", spiral.spin));
}

Chart spiral_panel(const SpiralDrawing& spiral) {
    Chart chart{spiral_title(spiral), "", "radii", {}};
    chart.x_scale = ChartScale::linear, chart.y_scale = ChartScale::linear;
    ChartSeries line{"", "#bbbbbb", {}, ChartSeries::Style::line}, taps{"", "#0072b2", {}, ChartSeries::Style::markers};
    const int steps = 100 * spiral.turns;
    for (int i = 0; i <= steps; ++i) {
        const Tap point = spiral_point(spiral, static_cast<double>(i) / steps);
        line.points.push_back({point.x, point.y});
    }
    for (const Tap& tap : taps_of(spiral)) taps.points.push_back({tap.x, tap.y});
    chart.series = {std::move(line), std::move(taps)};
    return chart;
}

// What the separable filter (bilateral_blur.h, gaussian_2015, on level ground) leaves at each pixel of a black square
// whose middle is 1. A pixel's neighbours are those within the square, as the filter has them.
std::vector<double> filtered_square(int size, int radius) {
    const double sigma = radius / 3.0;
    const int middle = size / 2;
    std::vector<double> along(static_cast<std::size_t>(size));  // what a row, filtered once, shows of its middle
    for (int x = 0; x < size; ++x) {
        double weights = 0.0, white = 0.0;
        for (int i = -radius; i <= radius; ++i) {
            if (x + i < 0 || x + i >= size) continue;
            const double weight = std::exp(-i * i / (2.0 * sigma * sigma));
            weights += weight;
            white += x + i == middle ? weight : 0.0;
        }
        along[static_cast<std::size_t>(x)] = white / weights;
    }
    std::vector<double> square;
    for (const double row : along) {
        for (const double column : along) square.push_back(row * column);
    }
    return square;
}

std::string grey_square(const std::vector<double>& values, int size, double left, double top, double side,
                        double brightest) {
    std::string svg;
    const double pixel = side / size;
    for (int i = 0; i < size * size; ++i) {
        const auto grey = static_cast<int>(std::lround(255.0 * values[static_cast<std::size_t>(i)] / brightest));
        // A little wider than they are, so that no seam shows between them.
        const int column = i % size, row = i / size;
        svg += fmt::format(
            "<rect x=\"{0:.2f}\" y=\"{1:.2f}\" width=\"{2:.2f}\" height=\"{2:.2f}\" fill=\"rgb({3},{3},{3})\"/>\n",
            left + pixel * column, top + pixel * row, pixel + 0.05, grey);
    }
    return svg;
}

std::string print_filter(const Drawing& drawing) {
    constexpr double side = 220.0, gap = 20.0, head = 60.0;
    std::vector<double> before(static_cast<std::size_t>(drawing.size * drawing.size), 0.0);
    before[before.size() / 2] = 1.0;
    const std::vector<double> after = filtered_square(drawing.size, drawing.radius);
    const double brightest = after[after.size() / 2];
    const double width =
        std::max(3.0 * gap + 2.0 * side, svg_title_letter_width * static_cast<double>(drawing.title.size()));
    std::string svg = open_svg(width, head + side + gap, drawing.title);
    svg += svg_text(gap, head - 8.0, "start", "before");
    svg += svg_text(2.0 * gap + side, head - 8.0, "start", fmt::format("after, white is {:.3f}", brightest));
    svg += grey_square(before, drawing.size, gap, head, side, 1.0);
    svg += grey_square(after, drawing.size, 2 * gap + side, head, side, brightest);
    return svg + "</svg>\n";
}

}  // namespace

bool is_drawing_file(const ConfigValue& table) { return ConfigReader(table, "").text("kind", "") == "drawing"; }

std::vector<Drawing> parse_drawings(const ConfigValue& table, const std::filesystem::path& file) {
    ConfigReader reader(table, file.string());
    for (const char* key : {"kind", "title", "question"}) reader.required_text(key);
    std::vector<Drawing> drawings;
    for (ConfigReader& drawing : reader.tables("drawings")) drawings.push_back(read_drawing(drawing));
    if (drawings.empty()) reader.fail("", "'drawings' is missing: write at least one [[drawings]] table");
    reader.finish();
    return drawings;
}

std::string print_drawing(const Drawing& drawing) {
    if (drawing.kind == Drawing::Kind::filter) return print_filter(drawing);
    std::vector<Chart> charts;
    for (const SpiralDrawing& spiral : drawing.spirals) charts.push_back(spiral_panel(spiral));
    return print_svg(charts, charts.size() < 3 ? static_cast<int>(charts.size()) : 3, drawing.title,
                     fmt::format("After {}.", drawing.source));
}

ResultTable drawing_numbers(const Drawing& drawing) {
    ResultTable table;
    if (drawing.kind == Drawing::Kind::filter) {
        table.columns = {"pixel", "x", "y", "value"};
        const std::vector<double> values = filtered_square(drawing.size, drawing.radius);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const auto size = static_cast<std::size_t>(drawing.size);
            table.rows.push_back({fmt::format("{}", i), fmt::format("{}", i % size), fmt::format("{}", i / size),
                                  fmt::format("{:.6g}", values[i])});
        }
        return table;
    }
    table.columns = {"spiral", "tap", "x", "y"};
    for (const SpiralDrawing& spiral : drawing.spirals) {
        const std::vector<Tap> taps = taps_of(spiral);
        for (std::size_t i = 0; i < taps.size(); ++i)
            table.rows.push_back({spiral_title(spiral), fmt::format("{}", i), fmt::format("{:.6g}", taps[i].x),
                                  fmt::format("{:.6g}", taps[i].y)});
    }
    return table;
}

}  // namespace plumb

#include "experiments/figures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "experiments/claims.h"
#include "experiments/svg_chart.h"

namespace plumb {
namespace {

// The values of an attribute among the cells that a figure looks at, in their order; one empty text without attribute.
std::vector<std::string> values_of(const std::string& attribute, const Figure& figure, const std::vector<Cell>& cells) {
    std::vector<std::string> values;
    for (const Cell& cell : cells) {
        if (!figure.where.matches(cell) || std::isnan(measure_of(cell, figure.y))) continue;
        const std::string value = attribute.empty() ? "" : attribute_of(cell, attribute);
        if (!attribute.empty() && value.empty()) continue;
        if (std::ranges::find(values, value) == values.end()) values.push_back(value);
    }
    return values;
}

// The attribute whose values tell the points of one series apart; empty where a series is one point.
std::string point_attribute(const Figure& figure) {
    if (figure.kind == FigureKind::bars) return figure.x;
    return figure.x == "parameter" || figure.series == "curve" ? "parameter" : "";
}

struct FigurePoint {
    std::string panel, series, category;
    double x = 0.0, y = 0.0, lower = 0.0, upper = 0.0;
    int count = 0;
};

MeanSummary average(const std::vector<MeasuredCase>& cases, bool geometric) {
    std::vector<double> values;
    for (const MeasuredCase& entry : cases) {
        if (!geometric || entry.value > 0.0) values.push_back(entry.value);
    }
    if (!geometric) return summarise_mean(values);
    const RatioSummary ratios = summarise_ratios(values);
    MeanSummary mean;
    mean.mean = ratios.mean, mean.lower = ratios.lower, mean.upper = ratios.upper, mean.count = ratios.count;
    return mean;
}

// The point of the cells that have these values.
std::optional<FigurePoint> make_point(const Figure& figure, const std::vector<Cell>& cells, const std::string& panel,
                                      const std::string& series, const std::string& category) {
    MeasuredQuantity quantity;
    quantity.measure = figure.y, quantity.where = figure.where;
    if (!figure.panels.empty()) quantity.where.wanted[figure.panels] = {panel};
    quantity.first.wanted[figure.series] = {series};
    const std::string attribute = point_attribute(figure);
    if (!attribute.empty()) quantity.first.wanted[attribute] = {category};
    quantity.second = figure.relative_to;
    const bool is_relative = !figure.relative_to.wanted.empty();
    // Where groups are scenes or views, the base is in the same one.
    if (is_relative && figure.kind == FigureKind::bars && figure.x != "method" && figure.x != "curve") {
        quantity.where.wanted[figure.x] = {category};
        quantity.first.wanted.erase(figure.x);
    }
    if (is_relative) quantity.kind = QuantityKind::ratio;
    const Measured measured = measure_quantity(cells, quantity);
    if (measured.cases.empty()) return std::nullopt;

    FigurePoint point{panel, series, category};
    const MeanSummary mean = is_relative ? measured.summary : average(measured.cases, !figure.linear_y);
    if (mean.count == 0) return std::nullopt;
    point.y = mean.mean, point.count = mean.count;
    if (is_relative && mean.has_interval()) point.lower = mean.lower, point.upper = mean.upper;
    if (figure.x == "parameter") point.x = std::stod(category);
    if (figure.kind == FigureKind::curves && figure.x != "parameter") {
        quantity.kind = QuantityKind::value, quantity.measure = figure.x;
        const Measured across = measure_quantity(cells, quantity);
        if (across.cases.empty()) return std::nullopt;
        point.x = average(across.cases, !figure.linear_x).mean;
    }
    return point;
}

std::vector<FigurePoint> points_of(const Figure& figure, const std::vector<Cell>& cells) {
    const std::vector<std::string> categories = values_of(point_attribute(figure), figure, cells);
    std::vector<FigurePoint> points;
    for (const std::string& panel : values_of(figure.panels, figure, cells)) {
        for (const std::string& series : values_of(figure.series, figure, cells)) {
            for (const std::string& category : categories) {
                if (auto point = make_point(figure, cells, panel, series, category)) points.push_back(*point);
            }
        }
    }
    return points;
}

Chart make_panel(const Figure& figure, const std::vector<FigurePoint>& points, const std::string& panel,
                 const std::vector<std::string>& categories) {
    Chart chart{panel, figure.x_label, figure.y_label, {}};
    const bool is_bars = figure.kind == FigureKind::bars;
    if (is_bars) chart.categories = categories;
    chart.x_scale = figure.linear_x ? ChartScale::linear : ChartScale::logarithmic;
    chart.y_scale = figure.linear_y ? ChartScale::linear : ChartScale::logarithmic;
    const auto style = is_bars ? ChartSeries::Style::bars : ChartSeries::Style::markers_and_line;
    std::vector<std::string> names;  // of all panels, so that a name has one colour
    for (const FigurePoint& point : points) {
        if (std::ranges::find(names, point.series) == names.end()) names.push_back(point.series);
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        ChartSeries series{names[i], chart_colour(i), {}, style};
        for (const FigurePoint& point : points) {
            if (point.panel != panel || point.series != names[i]) continue;
            const auto place = std::ranges::find(categories, point.category) - categories.begin();
            series.points.push_back(
                {is_bars ? static_cast<double>(place) : point.x, point.y, point.lower, point.upper});
        }
        std::ranges::stable_sort(series.points, {}, &ChartPoint::x);
        if (!series.points.empty()) chart.series.push_back(std::move(series));
    }
    return chart;
}

// One number of a table before it is averaged.
struct TableEntry {
    std::vector<std::string> group;  // attributes that the rows to be compared with each other share
    std::map<std::vector<std::string>, std::vector<double>> of_places;
};

TableEntry table_entry(const Figure& figure, const std::string& column, const std::vector<std::string>& key,
                       const std::vector<Cell>& cells) {
    TableEntry entry;
    MeasuredQuantity quantity;
    quantity.measure = column, quantity.where = figure.where;
    for (std::size_t i = 0; i < key.size(); ++i) {
        const std::string& attribute = figure.rows[i];
        quantity.first.wanted[attribute] = {key[i]};
        if (attribute != "method" && attribute != "curve" && attribute != "parameter") entry.group.push_back(key[i]);
    }
    for (const MeasuredCase& found : measure_quantity(cells, quantity).cases)
        entry.of_places[{found.scene, found.place, found.plane, found.truth}].push_back(found.value);
    return entry;
}

// The mean over those places that every row has with which it may be compared, so that no row looks better for lacking
// a hard one; with their number where some are left out. Where they share none: over its own.
std::string mean_text(const TableEntry& entry, const std::vector<TableEntry>& entries) {
    if (entry.of_places.empty()) return "-";
    std::set<std::vector<std::string>> all, common;
    for (const auto& [place, values] : entry.of_places) common.insert(place);
    for (const TableEntry& other : entries) {
        if (other.group != entry.group || other.of_places.empty()) continue;
        for (const auto& [place, values] : other.of_places) all.insert(place);
        std::erase_if(common, [&](const auto& place) { return !other.of_places.contains(place); });
    }
    std::vector<double> averaged;
    std::size_t places = 0;
    for (const auto& [place, values] : entry.of_places) {
        if (!common.empty() && !common.contains(place)) continue;
        averaged.insert(averaged.end(), values.begin(), values.end());
        ++places;
    }
    const std::string mean = short_number(summarise_mean(averaged).mean);
    return places == all.size() ? mean : fmt::format("{} ({} of {})", mean, places, all.size());
}

}  // namespace

std::string print_chart(const Figure& figure, const std::vector<Cell>& cells) {
    const std::vector<FigurePoint> points = points_of(figure, cells);
    if (points.empty()) return "";
    std::vector<std::string> categories;
    if (figure.kind == FigureKind::bars) categories = values_of(figure.x, figure, cells);
    std::vector<Chart> charts;
    for (const std::string& panel : values_of(figure.panels, figure, cells))
        charts.push_back(make_panel(figure, points, panel, categories));
    return print_svg(charts, std::min<int>(3, static_cast<int>(charts.size())), figure.title,
                     figure.source.empty() ? "" : fmt::format("After {}.", figure.source));
}

ResultTable chart_numbers(const Figure& figure, const std::vector<Cell>& cells) {
    const bool is_bars = figure.kind == FigureKind::bars;
    ResultTable table;
    table.columns = {
        figure.panels.empty() ? "panel" : figure.panels, figure.series, figure.x, figure.y, "lower", "upper", "cells"};
    table.names = is_bars ? 3 : 2;
    for (const FigurePoint& point : points_of(figure, cells)) {
        const bool has_interval = point.upper > point.lower;
        table.rows.push_back({point.panel, point.series, is_bars ? point.category : fmt::format("{:.6g}", point.x),
                              fmt::format("{:.6g}", point.y), has_interval ? fmt::format("{:.6g}", point.lower) : "",
                              has_interval ? fmt::format("{:.6g}", point.upper) : "", fmt::format("{}", point.count)});
    }
    return table;
}

ResultTable make_table(const Figure& figure, const std::vector<Cell>& cells) {
    std::vector<std::vector<std::string>> keys;
    for (const Cell& cell : cells) {
        if (!figure.where.matches(cell)) continue;
        std::vector<std::string> key;
        for (const std::string& attribute : figure.rows) key.push_back(attribute_of(cell, attribute));
        if (std::ranges::find(keys, key) == keys.end()) keys.push_back(std::move(key));
    }
    ResultTable table;
    table.columns = figure.rows, table.names = figure.rows.size();
    table.columns.insert(table.columns.end(), figure.columns.begin(), figure.columns.end());
    table.rows = keys;
    for (const std::string& column : figure.columns) {
        std::vector<TableEntry> entries;
        entries.reserve(keys.size());
        for (const std::vector<std::string>& key : keys) entries.push_back(table_entry(figure, column, key, cells));
        for (std::size_t i = 0; i < keys.size(); ++i) table.rows[i].push_back(mean_text(entries[i], entries));
    }
    return table;
}

namespace {

MeanSummary mean_of_row(const Originals& originals, const OriginalRow& row, const std::vector<Cell>& cells) {
    const MeasuredQuantity quantity{originals.measure, QuantityKind::value, originals.where, row.of, {}};
    return average(measure_quantity(cells, quantity).cases, true);
}

// Of one row to the row that it is over, paired view by view where both have the same views, else of their means.
std::string ratio_text(const Originals& originals, const OriginalRow& row, const OriginalRow& over,
                       const std::vector<Cell>& cells) {
    const MeasuredQuantity quantity{originals.measure, QuantityKind::ratio, originals.where, row.of, over.of};
    const MeanSummary paired = measure_quantity(cells, quantity).summary;
    if (paired.has_interval())
        return fmt::format("{} [{}, {}]", short_number(paired.mean), short_number(paired.lower),
                           short_number(paired.upper));
    if (paired.count > 0) return short_number(paired.mean);
    const MeanSummary ours = mean_of_row(originals, row, cells), theirs = mean_of_row(originals, over, cells);
    return ours.count > 0 && theirs.count > 0 ? short_number(ours.mean / theirs.mean) : "-";
}

}  // namespace

ResultTable make_originals_table(const Originals& originals, const std::vector<Cell>& cells) {
    ResultTable table;
    const std::string unit = originals.unit.empty() ? "" : fmt::format(", {}", originals.unit);
    table.columns = {originals.title, "original" + unit, "here" + unit,        "here / original",
                     "over",          "ratio, original", "ratio, here [95 %]", "views"};
    for (const OriginalRow& row : originals.rows) {
        const MeanSummary ours = mean_of_row(originals, row, cells);
        std::vector<std::string> line = {row.name, short_number(row.original),
                                         ours.count > 0 ? short_number(ours.mean) : "not here",
                                         ours.count > 0 ? short_number(ours.mean / row.original) : "-"};
        if (row.over.empty()) {
            line.insert(line.end(), {"-", "-", "-"});
        } else {
            const OriginalRow& over = *std::ranges::find(originals.rows, row.over, &OriginalRow::name);
            line.insert(line.end(), {over.name, short_number(row.original / over.original),
                                     ratio_text(originals, row, over, cells)});
        }
        line.push_back(fmt::format("{}", ours.count));
        table.rows.push_back(std::move(line));
    }
    return table;
}

}  // namespace plumb

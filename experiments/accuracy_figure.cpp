#include "experiments/accuracy_figure.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "experiments/pareto.h"
#include "experiments/result_files.h"
#include "experiments/statistics.h"
#include "experiments/svg_chart.h"
#include "experiments/terminal_table.h"

namespace plumb {
namespace {

struct PanelSubject {
    std::string scene, plane, truth;
    bool operator==(const PanelSubject&) const = default;
};

PanelSubject subject_of(const ResultRow& row) { return {row.scene, row.plane, row.truth}; }

// With a time and an error that logarithmic axes can show.
bool is_drawable(const ResultRow& row) {
    return row.measured && !row.oracle.any() && row.rmse() > 0.0 && row.timing.median > 0.0;
}

std::vector<PanelSubject> subjects_of(const RunResults& results) {
    std::vector<PanelSubject> subjects;
    for (const ResultRow& row : results.rows) {
        if (is_drawable(row) && std::ranges::find(subjects, subject_of(row)) == subjects.end())
            subjects.push_back(subject_of(row));
    }
    return subjects;
}

double geometric_mean(const std::vector<double>& values) { return summarise_ratios(values).mean; }

// A method or a number of samples, over the views.
struct AveragedPoint {
    std::string method, curve;
    int path_tracer_samples = 0;
    std::vector<double> milliseconds, rmse;

    CostPoint mean() const { return {geometric_mean(milliseconds), geometric_mean(rmse)}; }
};

std::vector<AveragedPoint> averaged_points(const RunResults& results, const PanelSubject& subject) {
    std::vector<AveragedPoint> points;
    for (const ResultRow& row : results.rows) {
        if (!is_drawable(row) || subject_of(row) != subject) continue;
        auto place = std::ranges::find(points, row.method, &AveragedPoint::method);
        if (place == points.end()) {
            points.push_back({row.method, row.curve, row.path_tracer_samples, {}, {}});
            place = std::prev(points.end());
        }
        place->milliseconds.push_back(row.timing.median), place->rmse.push_back(row.rmse());
    }
    return points;
}

// The path tracer's curve on one view.
CostCurve curve_at(const RunResults& results, const ResultRow& method) {
    std::vector<CostPoint> points;
    for (const ResultRow& row : results.rows) {
        if (row.path_tracer_samples == 0 || !is_drawable(row) || row.place() != method.place()) continue;
        if (subject_of(row) == subject_of(method)) points.push_back({row.timing.median, row.rmse()});
    }
    return CostCurve(points);
}

void compare_with_path_tracer(const RunResults& results, EqualRow& row) {
    std::vector<double> errors, times;
    for (const ResultRow& measured : results.rows) {
        if (!is_drawable(measured) || measured.method != row.method) continue;
        if (subject_of(measured) != PanelSubject{row.scene, row.plane, row.truth}) continue;
        const CostCurve curve = curve_at(results, measured);
        if (const auto error = curve.error_at(measured.timing.median)) {
            errors.push_back(error->value / measured.rmse());
            row.extrapolated_at_equal_time += error->extrapolated ? 1 : 0;
        }
        if (const auto time = curve.milliseconds_at(measured.rmse())) {
            times.push_back(time->value / measured.timing.median);
            row.extrapolated_at_equal_error += time->extrapolated ? 1 : 0;
        }
    }
    if (!errors.empty()) {
        const RatioSummary ratio = summarise_ratios(errors);
        row.rmse_ratio = ratio.mean;
        if (ratio.has_interval()) row.rmse_ratio_lower = ratio.lower, row.rmse_ratio_upper = ratio.upper;
    }
    if (!times.empty()) {
        const RatioSummary ratio = summarise_ratios(times);
        row.time_ratio = ratio.mean;
        if (ratio.has_interval()) row.time_ratio_lower = ratio.lower, row.time_ratio_upper = ratio.upper;
    }
}

std::string ratio_text(double ratio, double lower, double upper, int extrapolated) {
    if (ratio == 0.0) return "-";
    const std::string interval =
        std::isfinite(lower) && std::isfinite(upper) ? fmt::format(" [{:.2g}, {:.2g}]", lower, upper) : "";
    return fmt::format("{}{:.3g}{}", extrapolated > 0 ? "~" : "", ratio, interval);
}

Chart make_panel(const RunResults& results, const PanelSubject& subject) {
    Chart chart;
    chart.title = fmt::format("{}: {}{}", subject.scene, subject.plane,
                              subject.truth.empty() ? "" : fmt::format(" ({})", subject.truth));
    chart.x_label = "ms", chart.y_label = "RMSE";
    ChartSeries path_tracer{
        "path tracer", "#777777", {}, ChartSeries::Style::markers_and_line, ChartSeries::Marker::square};
    std::vector<ChartSeries> series;
    std::vector<CostPoint> methods;
    for (const AveragedPoint& point : averaged_points(results, subject)) {
        const CostPoint mean = point.mean();
        if (point.path_tracer_samples > 0) {
            path_tracer.points.push_back({mean.milliseconds, mean.error});
            path_tracer.labels.push_back(fmt::format("{}", point.path_tracer_samples));
            continue;
        }
        methods.push_back(mean);
        const std::string& name = point.curve.empty() ? point.method : point.curve;
        auto place = std::ranges::find(series, name, &ChartSeries::name);
        if (place == series.end()) {
            series.push_back({name, chart_colour(series.size()), {}});
            place = std::prev(series.end());
        }
        place->points.push_back({mean.milliseconds, mean.error});
    }
    ChartSeries front{methods.size() > 1 ? "front" : "", "#222222", {}, ChartSeries::Style::dashed_line};
    for (const std::size_t index : pareto_front(methods))
        front.points.push_back({methods[index].milliseconds, methods[index].error});
    if (front.points.size() > 1) chart.series.push_back(std::move(front));
    if (!path_tracer.points.empty()) chart.series.push_back(std::move(path_tracer));
    for (ChartSeries& one : series) chart.series.push_back(std::move(one));
    return chart;
}

}  // namespace

std::vector<EqualRow> equal_rows(const RunResults& results) {
    std::vector<EqualRow> rows;
    for (const PanelSubject& subject : subjects_of(results)) {
        std::vector<AveragedPoint> methods = averaged_points(results, subject);
        std::erase_if(methods, [](const AveragedPoint& point) { return point.path_tracer_samples > 0; });
        std::vector<CostPoint> points;
        points.reserve(methods.size());
        for (const AveragedPoint& method : methods) points.push_back(method.mean());
        const std::vector<std::size_t> front = pareto_front(points);
        for (std::size_t i = 0; i < methods.size(); ++i) {
            EqualRow row;
            row.scene = subject.scene, row.plane = subject.plane, row.truth = subject.truth;
            row.method = methods[i].method;
            row.views = static_cast<int>(methods[i].rmse.size());
            row.milliseconds = points[i].milliseconds, row.rmse = points[i].error;
            row.on_front = std::ranges::find(front, i) != front.end();
            compare_with_path_tracer(results, row);
            rows.push_back(std::move(row));
        }
    }
    return rows;
}

std::string print_equal_rows(const RunResults& results) {
    using Align = TerminalTable::Align;
    const std::vector<EqualRow> rows = equal_rows(results);
    if (rows.empty()) return "";
    TerminalTable table({{"scene"},
                         {"plane"},
                         {"truth"},
                         {"method"},
                         {"ms", Align::right},
                         {"RMSE", Align::right},
                         {"front"},
                         {"path tracer's RMSE, equal time", Align::right},
                         {"its time, equal RMSE", Align::right}});
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const EqualRow& row = rows[i];
        const bool is_new = i > 0 && std::tie(row.scene, row.plane, row.truth) !=
                                         std::tie(rows[i - 1].scene, rows[i - 1].plane, rows[i - 1].truth);
        if (is_new) table.add_rule();
        table.add_row(
            {row.scene, row.plane, row.truth, row.method, fmt::format("{:.3g}", row.milliseconds),
             fmt::format("{:.3g}", row.rmse), row.on_front ? "yes" : "",
             ratio_text(row.rmse_ratio, row.rmse_ratio_lower, row.rmse_ratio_upper, row.extrapolated_at_equal_time),
             ratio_text(row.time_ratio, row.time_ratio_lower, row.time_ratio_upper, row.extrapolated_at_equal_error)});
    }
    return table.print() +
           "Ratios of the path tracer to the method, geometric means over views with 95 % intervals: below 1 the path "
           "tracer is the better choice.\n~ its curve was continued beyond its first or last number of samples.\n";
}

std::string print_equal_rows_csv(const RunResults& results) {
    std::string text =
        "scene,plane,truth,method,views,milliseconds,rmse,on_front,equal_time_rmse_ratio,lower,upper,extrapolated,"
        "equal_error_time_ratio,lower,upper,extrapolated\n";
    for (const EqualRow& row : equal_rows(results)) {
        text += fmt::format("{},{},{},{},{},{:.6g},{:.6g},{},{:.6g},{},{},{},{:.6g},{},{},{}\n", csv_text(row.scene),
                            csv_text(row.plane), csv_text(row.truth), csv_text(row.method), row.views, row.milliseconds,
                            row.rmse, row.on_front ? 1 : 0, row.rmse_ratio, csv_number(row.rmse_ratio_lower),
                            csv_number(row.rmse_ratio_upper), row.extrapolated_at_equal_time, row.time_ratio,
                            csv_number(row.time_ratio_lower), csv_number(row.time_ratio_upper),
                            row.extrapolated_at_equal_error);
    }
    return text;
}

std::string print_accuracy_figure(const RunResults& results) {
    std::vector<Chart> charts;
    for (const PanelSubject& subject : subjects_of(results)) charts.push_back(make_panel(results, subject));
    if (charts.empty()) return "";
    const int columns = std::min<int>(3, static_cast<int>(charts.size()));
    return print_svg(charts, columns, fmt::format("{}: what accuracy costs", results.experiment.title),
                     "Geometric means over views. Numbers at the path tracer's curve: samples per pixel.");
}

}  // namespace plumb

#include "experiments/convergence_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "embedded/page.h"
#include "experiments/build_facts.h"
#include "experiments/page.h"
#include "experiments/result_files.h"
#include "experiments/run_json.h"
#include "experiments/svg_chart.h"
#include "experiments/terminal_table.h"
#include "frames/atomic_file.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

std::string name_of(SamplePoints points) { return points == SamplePoints::sobol ? "Sobol" : "random"; }

std::string slope_text(const ConvergenceCurve& curve) {
    if (curve.slope.count == 0) return "-";
    return fmt::format("{:.3f} ± {:.3f}", curve.slope.mean, curve.slope.standard_error);
}

std::string rmse_text(double rmse) { return rmse > 0.0 ? fmt::format("{:.3g}", rmse) : "-"; }

// The largest number of samples at which both curves have an error; 0: none.
int last_common(const ConvergenceExperiment& experiment, const ConvergenceCurve& a, const ConvergenceCurve& b) {
    int last = 0;
    for (const int samples : experiment.samples) {
        if (a.rmse(samples) > 0.0 && b.rmse(samples) > 0.0) last = samples;
    }
    return last;
}

struct TableLine {
    std::string scene, view, plane, random, sobol, last_random, last_sobol, samples, gain;
};

// One line per scene and plane.
std::vector<TableLine> table_lines(const ConvergenceResults& results) {
    std::vector<TableLine> lines;
    for (std::size_t i = 0; i + 1 < results.curves.size(); i += 2) {
        const ConvergenceCurve &random = results.curves[i], &sobol = results.curves[i + 1];
        const int last = last_common(results.experiment, random, sobol);
        TableLine line{random.scene, random.view, random.plane, slope_text(random), slope_text(sobol), "-",
                       "-",          "-",         "-"};
        if (last > 0) {
            line.samples = fmt::format("{}", last);
            line.last_random = rmse_text(random.rmse(last)), line.last_sobol = rmse_text(sobol.rmse(last));
            // Random points' squared error falls with 1 / samples.
            line.gain = fmt::format("{:.3g}", std::pow(random.rmse(last) / sobol.rmse(last), 2.0));
        }
        lines.push_back(line);
    }
    return lines;
}

constexpr const char* gain_note =
    "gain: how many times as many random points it would take for the error of Sobol points; slopes of log RMSE over "
    "log samples ± standard error over the seeds.";

}  // namespace

std::string print_convergence_table(const ConvergenceResults& results) {
    using Align = TerminalTable::Align;
    TerminalTable table({{"scene"},
                         {"view"},
                         {"plane"},
                         {"slope, random", Align::right},
                         {"slope, Sobol", Align::right},
                         {"samples", Align::right},
                         {"RMSE, random", Align::right},
                         {"RMSE, Sobol", Align::right},
                         {"gain", Align::right}});
    std::string scene;
    for (const TableLine& line : table_lines(results)) {
        if (!scene.empty() && scene != line.scene) table.add_rule();
        scene = line.scene;
        table.add_row({line.scene, line.view, line.plane, line.random, line.sobol, line.samples, line.last_random,
                       line.last_sobol, line.gain});
    }
    return fmt::format("{}{}\n", table.print(), gain_note);
}

std::string print_convergence_csv(const ConvergenceResults& results) {
    std::string text = "scene,view,plane,points,seed,samples,mse,rmse,reference_noise_mse,used\n";
    for (const ConvergenceCurve& curve : results.curves) {
        for (const ConvergenceMeasurement& measurement : curve.measurements) {
            text += fmt::format("{},{},{},{},{},{},{:.9g},{:.9g},{:.9g},{}\n", csv_text(curve.scene),
                                csv_text(curve.view), csv_text(curve.plane), name_of(curve.points), measurement.seed,
                                measurement.samples, measurement.mse, std::sqrt(std::max(0.0, measurement.mse)),
                                measurement.noise_mse, measurement.used ? 1 : 0);
        }
    }
    return text;
}

std::string print_convergence_json(const ConvergenceResults& results) {
    const ConvergenceExperiment& experiment = results.experiment;
    Json json = run_json(results.command, results.started, results.seconds, results.system);
    json["experiment"] = {{"title", experiment.title},
                          {"question", experiment.question},
                          {"planes", experiment.planes},
                          {"resolution", {experiment.width, experiment.height}},
                          {"bounces", experiment.quantities.bounces},
                          {"ao_falloff", to_string(experiment.quantities.ao_falloff)},
                          {"samples", experiment.samples},
                          {"seeds", experiment.seeds},
                          {"reference_samples", experiment.reference_samples},
                          {"most_noise", experiment.most_noise}};
    for (const ConvergenceScene& scene : experiment.scenes) {
        json["experiment"]["scenes"].push_back(
            {{"scene", scene.scene}, {"view", scene.view}, {"ao_radius", number_json(scene.ao_radius)}});
    }
    json["failures"] = failures_json(results.failures);
    json["curves"] = Json::array();
    for (const ConvergenceCurve& curve : results.curves) {
        Json entry = {{"scene", curve.scene},
                      {"view", curve.view},
                      {"plane", curve.plane},
                      {"points", name_of(curve.points)},
                      {"slope",
                       {{"mean", curve.slope.mean},
                        {"standard_error", number_json(curve.slope.standard_error)},
                        {"lower", number_json(curve.slope.lower)},
                        {"upper", number_json(curve.slope.upper)},
                        {"seeds", curve.slope.count}}},
                      {"rmse_at_one_sample", curve.rmse_at_one}};
        for (const int samples : experiment.samples)
            entry["rmse"].push_back({{"samples", samples}, {"rmse", curve.rmse(samples)}});
        json["curves"].push_back(std::move(entry));
    }
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string print_convergence_figure(const ConvergenceResults& results) {
    const ConvergenceExperiment& experiment = results.experiment;
    std::vector<Chart> charts;
    for (const std::string& plane : experiment.planes) {
        for (const ConvergenceScene& scene : experiment.scenes) {
            Chart chart{fmt::format("{}: {}", scene.scene, plane), "samples per pixel", "RMSE", {}};
            for (const ConvergenceCurve& curve : results.curves) {
                if (curve.scene != scene.scene || curve.plane != plane) continue;
                if (!scene.view.empty() && curve.view != scene.view) continue;
                const bool sobol = curve.points == SamplePoints::sobol;
                ChartSeries measured{fmt::format("{} {}", name_of(curve.points), slope_text(curve)),
                                     sobol ? "#0072b2" : "#d55e00",
                                     {},
                                     ChartSeries::Style::markers,
                                     sobol ? ChartSeries::Marker::circle : ChartSeries::Marker::square};
                for (const int samples : experiment.samples) {
                    measured.points.push_back({static_cast<double>(samples), curve.rmse(samples),
                                               curve.least_rmse(samples), curve.greatest_rmse(samples)});
                }
                ChartSeries fitted{"", measured.colour, {}, ChartSeries::Style::line, measured.marker};
                for (const int samples : {experiment.samples.front(), experiment.samples.back()}) {
                    fitted.points.push_back({static_cast<double>(samples),
                                             curve.rmse_at_one * std::pow(samples, curve.slope.mean), 0.0, 0.0});
                }
                chart.series.push_back(std::move(measured));
                chart.series.push_back(std::move(fitted));
            }
            charts.push_back(std::move(chart));
        }
    }
    return print_svg(
        charts, static_cast<int>(experiment.scenes.size()), experiment.title,
        fmt::format("Root of the mean over {} seeds, bars from the least to the greatest; lines and slopes "
                    "by least squares, ± the standard error over seeds. {} x {} pixels, {} bounces.",
                    experiment.seeds, experiment.width, experiment.height, experiment.quantities.bounces));
}

std::string print_convergence_page(const ConvergenceResults& results) {
    const ConvergenceExperiment& experiment = results.experiment;
    const BuildFacts& build = build_facts();
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
        "content=\"width=device-width, initial-scale=1\">\n<title>{0} - Plumbline</title>\n<style>{1}\nsvg {{ "
        "max-width: 100%; height: auto; }}</style>\n</head>\n<body>\n<header><p class=\"program\">Plumbline</p>"
        "<h1>{0}</h1><p class=\"question\">{2}</p></header>\n<main>\n<div class=\"scroll\">{3}</div>\n",
        escape_html(experiment.title), embedded::page::find("page.css"), escape_html(experiment.question),
        print_convergence_figure(results));
    html +=
        "<h2>Slopes</h2>\n<div class=\"scroll\"><table><thead><tr><th>scene</th><th>view</th><th>plane</th>"
        "<th class=\"number\">slope, random</th><th class=\"number\">slope, Sobol</th><th class=\"number\">samples"
        "</th><th class=\"number\">RMSE, random</th><th class=\"number\">RMSE, Sobol</th><th class=\"number\">gain"
        "</th></tr></thead><tbody>\n";
    for (const TableLine& line : table_lines(results)) {
        html += "<tr>";
        for (const std::string& cell : {line.scene, line.view, line.plane})
            html += fmt::format("<td>{}</td>", escape_html(cell));
        for (const std::string& cell :
             {line.random, line.sobol, line.samples, line.last_random, line.last_sobol, line.gain})
            html += fmt::format("<td class=\"number\">{}</td>", escape_html(cell));
        html += "</tr>\n";
    }
    html += fmt::format(
        "</tbody></table></div>\n<p class=\"note\">{}</p>\n<h2>How it was measured</h2>\n<p class=\"note\">Each image "
        "is compared with {} Sobol samples per pixel of another seed, by its two halves A and B: mean((I - A)(I - B)) "
        "is free of the reference's noise. A point counts where the reference's mean squared noise is at most {} of "
        "its error.</p>\n<p class=\"note\">{} - plumbline {} ({}), {} build - {} - {} - {:.0f} s</p>\n</main>\n"
        "</body>\n</html>\n",
        escape_html(gain_note), experiment.reference_samples, experiment.most_noise, escape_html(results.command),
        build.version, build.git_describe, build.build_type, escape_html(results.system.cpu), results.started,
        results.seconds);
    return html;
}

void write_convergence_files(const ConvergenceResults& results, const std::filesystem::path& folder) {
    write_text_atomically(folder / "convergence.csv", print_convergence_csv(results));
    write_text_atomically(folder / "convergence.json", print_convergence_json(results));
    write_text_atomically(folder / "convergence.svg", print_convergence_figure(results));
    write_text_atomically(folder / "index.html", print_convergence_page(results));
}

}  // namespace plumb

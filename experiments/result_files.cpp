#include "experiments/result_files.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/page.h"
#include "experiments/run_json.h"
#include "frames/atomic_file.h"
#include "metrics/comparison.h"
#include "metrics/gbuffer_fidelity.h"
#include "rasterizer/pass_timer.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

// Typed, so that a reader need not parse texts; an infinite radius is the text "inf", as in TOML.
Json parameters_of(const Method& method) {
    Method copy = method;
    Json json = Json::object();
    for (const MethodParameter& parameter : method_parameters(copy)) {
        json[parameter.name] = Json::parse(print_parameter(parameter), nullptr, false);
        if (json[parameter.name].is_discarded()) json[parameter.name] = print_parameter(parameter);
    }
    return json;
}

Json passes_of(const Timing& timing) {
    Json json = Json::object();
    for (const PassTiming& pass : timing.passes) json[pass.pass] = pass.milliseconds;
    return json;
}

Json stability_json(const PathStabilityResult& stability) {
    Json json = Json::object();
    for (const auto& [name, value] : stability.measures()) json[name] = number_json(value);
    json.erase("flicker_trustworthy");
    json["trustworthy"] = stability.trustworthy;
    return json;
}

Json measures_json(const std::vector<std::pair<std::string, double>>& measures) {
    Json json = Json::object();
    for (const auto& [name, value] : measures) json[name] = number_json(value);
    return json;
}

void add_path(const ResultRow& row, Json& json) {
    if (row.stability) json["stability"] = stability_json(*row.stability);
    if (row.lag) {
        json["lag"] = {
            {"frames", row.lag->value}, {"lower", number_json(row.lag->lower)}, {"upper", number_json(row.lag->upper)}};
    }
    for (const RegionError& region : row.regions) {
        if (region.stability) json["regions"][region.region]["stability"] = stability_json(*region.stability);
    }
    for (const FrameMeasure& frame : row.frames) {
        json["frames"].push_back(
            {{"time", frame.time}, {"rmse", number_json(frame.rmse)}, {"flicker", number_json(frame.flicker)}});
    }
}

Json row_json(const ResultRow& row) {
    Json json = {
        {"scene", row.scene}, {"view", row.view}, {"plane", row.plane}, {"truth", row.truth}, {"method", row.method}};
    if (!row.path.empty()) json["path"] = row.path;
    if (!row.curve.empty())
        json["sweep"] = {{"curve", row.curve}, {"parameter", row.curve_parameter}, {"value", row.curve_value}};
    if (row.path_tracer_samples > 0) {
        json["path_tracer_samples"] = row.path_tracer_samples;
    } else if (row.oracle.any()) {
        if (row.oracle.layers >= 0) json["oracle_layers"] = row.oracle.layers;
        if (row.oracle.bounces > 0) json["oracle_bounces"] = row.oracle.bounces;
    } else {
        json["method_hash"] = fmt::format("{:016x}", method_hash(row.parameters));
        json["parameters"] = parameters_of(row.parameters);
    }
    json["measured"] = row.measured;
    if (!row.measured) json["refusal"] = row.refusal;
    json["reference_samples"] = row.reference_samples;
    if (row.seeds > 1) {
        json["seeds"] = {{"pictures", row.seeds},
                         {"unbiased_mse_lower", number_json(row.seeds_mse_lower)},
                         {"unbiased_mse_upper", number_json(row.seeds_mse_upper)}};
    }
    json["unbiased_mse"] = {{"mse", number_json(row.mse)},
                            {"lower", number_json(row.mse_lower)},
                            {"upper", number_json(row.mse_upper)},
                            {"reference_noise", number_json(row.noise_mse)}};
    for (const auto& [name, estimate] : row.over_seeds) {
        json["seeds"][name + "_lower"] = number_json(estimate.lower);
        json["seeds"][name + "_upper"] = number_json(estimate.upper);
    }
    json["measures"] = measures_json(row.measures);
    for (const RegionError& region : row.regions) {
        json["regions"][region.region] = {{"pixels", region.pixels},
                                          {"unbiased_mse", number_json(region.mse)},
                                          {"lower", number_json(region.mse_lower)},
                                          {"upper", number_json(region.mse_upper)},
                                          {"measured", region.measured},
                                          {"measures", measures_json(region.measures)}};
    }
    if (!row.fidelity.empty()) json["gbuffer"] = measures_json(row.fidelity);
    add_path(row, json);
    json["milliseconds"] = {{"median", row.timing.median},
                            {"lower_quartile", row.timing.lower_quartile},
                            {"upper_quartile", row.timing.upper_quartile},
                            {"repetitions", row.timing.repetitions},
                            {"passes", passes_of(row.timing)}};
    if (row.is_method()) json["gbuffer_bytes_per_pixel"] = row.gbuffer_bytes_per_pixel;
    return json;
}

Json experiment_json(const Experiment& experiment) {
    Json json = {{"name", experiment.name},
                 {"title", experiment.title},
                 {"question", experiment.question},
                 {"file", experiment.file.filename().string()},
                 {"quick", experiment.quick}};
    json["oracle"] = experiment.oracle_layers;
    json["oracle_bounces"] = experiment.oracle_bounces;
    json["planes"] = experiment.planes;
    json["resolution"] = {experiment.width, experiment.height};
    json["bounces"] = experiment.quantities.bounces;
    json["ao_falloff"] = to_string(experiment.quantities.ao_falloff);
    json["indirect_falloff"] = to_string(experiment.quantities.indirect_falloff);
    json["reference"] = {
        {"samples", experiment.reference.samples},           {"path_samples", experiment.reference.path_samples},
        {"target_error", experiment.reference.target_error}, {"seed", experiment.reference.seed},
        {"antialias", experiment.reference.antialias},       {"most_noise", experiment.reference.most_noise}};
    json["seeds"] = experiment.seeds;
    json["measures"] = {{"flip", to_string(experiment.measures.flip)},
                        {"pixels_per_degree", experiment.measures.pixels_per_degree}};
    json["timing"] = {{"warm_up", experiment.timing.warm_up}, {"repetitions", experiment.timing.repetitions}};
    json["path_tracer_samples"] = experiment.path_tracer_samples;
    json["baseline"] = experiment.baseline;
    json["scenes"] = Json::array();
    for (const ExperimentScene& scene : experiment.scenes) {
        Json entry = {{"scene", scene.scene},
                      {"views", scene.views},
                      {"ao_radius", scene.ao_radius},
                      {"indirect_radius", number_json(scene.indirect_radius)},
                      {"minimum_separation", scene.minimum_separation}};
        for (const ExperimentPath& path : scene.paths) {
            entry["paths"].push_back({{"path", path.path},
                                      {"start", path.start},
                                      {"frames", path.frames},
                                      {"frames_per_second", path.frames_per_second}});
        }
        json["scenes"].push_back(std::move(entry));
    }
    json["methods"] = Json::array();
    for (const Method& method : experiment.methods) {
        json["methods"].push_back({{"name", method.name}, {"parameters", parameters_of(method)}});
    }
    return json;
}

Json ladder_json(const Waterfall& waterfall) {
    Json json = {{"title", waterfall.title}, {"rungs", Json::array()}};
    for (const WaterfallBar& bar : waterfall.bars) {
        json["rungs"].push_back({{"rung", bar.label},
                                 {"rmse_above", bar.from},
                                 {"rmse", bar.to},
                                 {"adds_lower", number_json(bar.change_lower)},
                                 {"adds_upper", number_json(bar.change_upper)},
                                 {"time", bar.note}});
    }
    return json;
}

// What both CSV files begin their lines with.
constexpr const char* row_columns = "scene,view,path,plane,truth,method";

std::string row_names(const ResultRow& row) {
    return fmt::format("{},{},{},{},{},{}", csv_text(row.scene), csv_text(row.view), csv_text(row.path),
                       csv_text(row.plane), csv_text(row.truth), csv_text(row.method));
}

// Each with a comma before it.
std::string columns(const std::vector<std::string>& names) { return fmt::format(",{}", fmt::join(names, ",")); }

std::string values(const std::vector<std::string>& names, const std::vector<std::pair<std::string, double>>& measures) {
    std::string text;
    for (const std::string& name : names) text.append(",").append(csv_number(measure_named(measures, name)));
    return text;
}

std::string stability_values(const std::optional<PathStabilityResult>& stability) {
    return values(stability_names(), stability ? stability->measures() : std::vector<std::pair<std::string, double>>{});
}

}  // namespace

std::string csv_number(double value) { return std::isnan(value) ? "" : fmt::format("{:.9g}", value); }

std::string csv_text(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char letter : text) quoted.append(letter == '"' ? 2 : 1, letter);
    quoted.push_back('"');
    return quoted;
}

std::string print_csv(const RunResults& results) {
    std::string text = fmt::format(
        "{},curve,curve_parameter,curve_value,oracle_layers,oracle_bounces,path_tracer_samples,measured,reference_"
        "samples,seeds,"
        "mse_lower_over_seeds,mse_upper_over_seeds{}{},lag,lag_lower,lag_upper{},milliseconds,"
        "milliseconds_lower_quartile,milliseconds_upper_quartile,repetitions,gbuffer_bytes_per_pixel,refusal\n",
        row_columns, columns(measure_names()), columns(stability_names()), columns(fidelity_names()));
    for (const ResultRow& row : results.rows) {
        const Estimate lag = row.lag.value_or(Estimate{no_value, no_value, no_value});
        text += fmt::format(
            "{},{},{},{},{},{},{},{},{},{},{},{}{}{},{},{},{}{},{},{},{},{},{},{}\n", row_names(row),
            csv_text(row.curve), csv_text(row.curve_parameter), row.curve.empty() ? "" : csv_number(row.curve_value),
            row.oracle.layers >= 0 ? fmt::format("{}", row.oracle.layers) : "",
            row.oracle.bounces > 0 ? fmt::format("{}", row.oracle.bounces) : "", row.path_tracer_samples,
            row.measured ? 1 : 0, row.reference_samples, row.seeds, csv_number(row.seeds_mse_lower),
            csv_number(row.seeds_mse_upper), values(measure_names(), row.measures), stability_values(row.stability),
            csv_number(lag.value), csv_number(lag.lower), csv_number(lag.upper), values(fidelity_names(), row.fidelity),
            csv_number(row.timing.median), csv_number(row.timing.lower_quartile), csv_number(row.timing.upper_quartile),
            row.timing.repetitions, row.gbuffer_bytes_per_pixel, csv_text(row.refusal));
    }
    return text;
}

std::string print_regions_csv(const RunResults& results) {
    std::string text = fmt::format("{},region,pixels,measured{}{}\n", row_columns, columns(measure_names()),
                                   columns(stability_names()));
    for (const ResultRow& row : results.rows) {
        for (const RegionError& region : row.regions) {
            text += fmt::format("{},{},{},{}{}{}\n", row_names(row), csv_text(region.region), region.pixels,
                                region.measured ? 1 : 0, values(measure_names(), region.measures),
                                stability_values(region.stability));
        }
    }
    return text;
}

std::string print_json(const RunResults& results) {
    Json json = run_json(results.command, results.started, results.seconds, results.system);
    json["interrupted"] = results.interrupted;
    json["gl"] = {{"backend", results.gl_backend},   {"vendor", results.gl_vendor},
                  {"renderer", results.gl_renderer}, {"version", results.gl_version},
                  {"software", results.gl_software}, {"timer", timer_description(results.gl_software)}};
    json["experiment"] = experiment_json(results.experiment);
    json["experiment_text"] = results.experiment_text;
    json["method_files"] = results.experiment.method_files;
    json["scene_hashes"] = results.scene_hashes;
    json["summary"] = results.summary;
    json["references"] = Json::array();
    for (const ReferenceUse& use : results.references) {
        json["references"].push_back({{"scene", use.scene},
                                      {"view", use.view},
                                      {"truth", use.truth},
                                      {"samples", use.samples},
                                      {"seconds", use.seconds},
                                      {"from_cache", use.from_cache}});
    }
    json["failures"] = Json::array();
    for (const CellFailure& failure : results.failures) {
        json["failures"].push_back({{"cell", failure.cell}, {"message", failure.message}});
    }
    json["ladders"] = Json::array();
    for (const Waterfall& waterfall : results.waterfalls) json["ladders"].push_back(ladder_json(waterfall));
    json["rows"] = Json::array();
    for (const ResultRow& row : results.rows) json["rows"].push_back(row_json(row));
    return print_json_lines(json);
}

void write_result_files(const RunResults& results, const std::filesystem::path& folder) {
    write_text_atomically(folder / "results.csv", print_csv(results));
    write_text_atomically(folder / "regions.csv", print_regions_csv(results));
    write_text_atomically(folder / "results.json", print_json(results));
    write_text_atomically(folder / "index.html", print_page(results, folder));
}

}  // namespace plumb

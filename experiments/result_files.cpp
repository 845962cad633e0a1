#include "experiments/result_files.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/page.h"
#include "experiments/run_json.h"
#include "frames/atomic_file.h"
#include "metrics/comparison.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

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

Json row_json(const ResultRow& row) {
    Json json = {
        {"scene", row.scene}, {"view", row.view}, {"plane", row.plane}, {"truth", row.truth}, {"method", row.method}};
    if (row.path_tracer_samples > 0) {
        json["path_tracer_samples"] = row.path_tracer_samples;
    } else {
        json["method_hash"] = fmt::format("{:016x}", method_hash(row.parameters));
        json["parameters"] = parameters_of(row.parameters);
    }
    json["measured"] = row.measured;
    if (!row.measured) json["refusal"] = row.refusal;
    json["reference_samples"] = row.reference_samples;
    json["measures"] = Json::object();
    for (const auto& [name, value] : row.measures) json["measures"][name] = number(value);
    json["milliseconds"] = {{"median", row.timing.median},
                            {"lower_quartile", row.timing.lower_quartile},
                            {"upper_quartile", row.timing.upper_quartile},
                            {"repetitions", row.timing.repetitions},
                            {"passes", passes_of(row.timing)}};
    if (row.path_tracer_samples == 0) json["gbuffer_bytes_per_pixel"] = row.gbuffer_bytes_per_pixel;
    return json;
}

Json experiment_json(const Experiment& experiment) {
    Json json = {{"name", experiment.name},
                 {"title", experiment.title},
                 {"question", experiment.question},
                 {"file", experiment.file.filename().string()},
                 {"quick", experiment.quick}};
    json["planes"] = experiment.planes;
    json["resolution"] = {experiment.width, experiment.height};
    json["bounces"] = experiment.quantities.bounces;
    json["ao_falloff"] = to_string(experiment.quantities.ao_falloff);
    json["indirect_falloff"] = to_string(experiment.quantities.indirect_falloff);
    json["reference"] = {{"samples", experiment.reference.samples},
                         {"target_error", experiment.reference.target_error},
                         {"seed", experiment.reference.seed},
                         {"most_noise", experiment.reference.most_noise}};
    json["timing"] = {{"warm_up", experiment.timing.warm_up}, {"repetitions", experiment.timing.repetitions}};
    json["path_tracer_samples"] = experiment.path_tracer_samples;
    json["baseline"] = experiment.baseline;
    json["scenes"] = Json::array();
    for (const ExperimentScene& scene : experiment.scenes) {
        json["scenes"].push_back({{"scene", scene.scene},
                                  {"views", scene.views},
                                  {"ao_radius", scene.ao_radius},
                                  {"indirect_radius", number(scene.indirect_radius)},
                                  {"minimum_separation", scene.minimum_separation}});
    }
    json["methods"] = Json::array();
    for (const Method& method : experiment.methods) {
        json["methods"].push_back({{"name", method.name}, {"parameters", parameters_of(method)}});
    }
    return json;
}

std::string csv_number(double value) { return std::isnan(value) ? "" : fmt::format("{:.9g}", value); }

}  // namespace

std::string csv_text(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char letter : text) quoted.append(letter == '"' ? 2 : 1, letter);
    quoted.push_back('"');
    return quoted;
}

std::string print_csv(const RunResults& results) {
    std::string text = "scene,view,plane,truth,method,path_tracer_samples,measured,reference_samples";
    for (const std::string& name : measure_names()) text.append(",").append(name);
    text +=
        ",milliseconds,milliseconds_lower_quartile,milliseconds_upper_quartile,repetitions,gbuffer_bytes_per_pixel,"
        "refusal\n";
    for (const ResultRow& row : results.rows) {
        text += fmt::format("{},{},{},{},{},{},{},{}", csv_text(row.scene), csv_text(row.view), csv_text(row.plane),
                            csv_text(row.truth), csv_text(row.method), row.path_tracer_samples, row.measured ? 1 : 0,
                            row.reference_samples);
        for (const auto& [name, value] : row.measures) text.append(",").append(csv_number(value));
        text += fmt::format(",{},{},{},{},{},{}\n", csv_number(row.timing.median),
                            csv_number(row.timing.lower_quartile), csv_number(row.timing.upper_quartile),
                            row.timing.repetitions, row.gbuffer_bytes_per_pixel, csv_text(row.refusal));
    }
    return text;
}

std::string print_json(const RunResults& results) {
    Json json = run_json(results.command, results.started, results.seconds, results.system);
    json["interrupted"] = results.interrupted;
    json["gl"] = {{"backend", results.gl_backend},
                  {"vendor", results.gl_vendor},
                  {"renderer", results.gl_renderer},
                  {"version", results.gl_version},
                  {"software", results.gl_software}};
    json["experiment"] = experiment_json(results.experiment);
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
    json["rows"] = Json::array();
    for (const ResultRow& row : results.rows) json["rows"].push_back(row_json(row));
    // Bytes that are no UTF-8 (a file name) are replaced rather than losing all results.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_result_files(const RunResults& results, const std::filesystem::path& folder) {
    write_text_atomically(folder / "results.csv", print_csv(results));
    write_text_atomically(folder / "results.json", print_json(results));
    write_text_atomically(folder / "index.html", print_page(results, folder));
}

}  // namespace plumb

#include "experiments/page.h"

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include <OpenImageIO/strutil.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "embedded/page.h"
#include "experiments/build_facts.h"
#include "experiments/pictures.h"
#include "frames/colour_map.h"
#include "frames/image_error.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string data_uri(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream bytes;
    if (!stream || !(bytes << stream.rdbuf())) {
        throw ImageError(fmt::format("cannot read '{}', which belongs on the page", file.string()));
    }
    return "data:image/png;base64," + OIIO::Strutil::base64_encode(bytes.str());
}

Json rows_json(const RunResults& results) {
    Json rows = Json::array();
    for (const ResultRow& row : results.rows) {
        Json json = {{"scene", row.scene}, {"view", row.view},     {"plane", row.plane},
                     {"truth", row.truth}, {"method", row.method}, {"path_tracer_samples", row.path_tracer_samples}};
        json["rmse"] = row.measured ? number(row.rmse()) : Json(nullptr);
        json["rmse_lower"] = number(row.rmse_lower());
        json["rmse_upper"] = number(row.rmse_upper());
        json["psnr"] = row.measured ? number(row.psnr) : Json(nullptr);
        json["ssim"] = row.measured ? number(row.ssim) : Json(nullptr);
        json["noise"] = number(std::sqrt(row.noise_mse));
        json["refusal"] = row.refusal;
        json["milliseconds"] = row.timing.median;
        json["milliseconds_lower"] = row.timing.repetitions > 1 ? number(row.timing.lower_quartile) : Json(nullptr);
        json["milliseconds_upper"] = row.timing.repetitions > 1 ? number(row.timing.upper_quartile) : Json(nullptr);
        rows.push_back(std::move(json));
    }
    return rows;
}

Json pictures_json(const RunResults& results, const std::filesystem::path& folder, Json& files) {
    Json sets = Json::array();
    for (const PictureSet& set : results.pictures) {
        Json images = Json::array();
        for (const Picture& picture : set.images) {
            images.push_back(
                {{"label", picture.label}, {"kind", picture.kind}, {"file", picture.file}, {"note", picture.note}});
            // A method's picture belongs to both truths' sets, and is contained once.
            if (!files.contains(picture.file)) files[picture.file] = data_uri(folder / picture.file);
        }
        sets.push_back({{"scene", set.scene},
                        {"view", set.view},
                        {"plane", set.plane},
                        {"truth", set.truth},
                        {"error_scale", set.error_scale},
                        {"exposure_note", set.exposure_note},
                        {"images", images}});
    }
    return sets;
}

Json colour_stops() {
    constexpr int last = 16;
    Json stops = Json::array();
    for (int i = 0; i <= last; ++i) {
        const auto colour = colour_at(error_colour_map, static_cast<float>(i) / last);
        stops.push_back(fmt::format("rgb({:.0f}, {:.0f}, {:.0f})", 255 * colour[0], 255 * colour[1], 255 * colour[2]));
    }
    return stops;
}

Json notes_json(const RunResults& results) {
    const Experiment& experiment = results.experiment;
    Json notes = Json::array();
    notes.push_back(
        "RMSE is the root of mean((I - A)(I - B)) over the truth's two independent halves A and B, which the truth's "
        "own noise does not bias; its interval is a block bootstrap over the image.");
    notes.push_back(
        fmt::format("A cell is refused where the mean squared noise of the truth is more than {:.0f} % of the squared "
                    "difference, or where the difference's interval includes zero.",
                    100.0 * experiment.reference.most_noise));
    notes.push_back(
        "PSNR and SSIM are taken of linear values; peak and data range are the 99th percentile of the truth (1 for "
        "ao).");
    notes.push_back(
        "Of indirect light there are two truths: 'full' is all of it, what a user wants; 'within ... m' is only what "
        "arrives from within the radius that the methods gather from, what they tried.");
    notes.push_back(fmt::format(
        "A time is that of all passes that the plane needs, and of no others: {} warm-up, then the median of "
        "{} frames, methods taking turns{}.",
        experiment.timing.warm_up, experiment.timing.repetitions,
        results.gl_software ? "; OpenGL ran on the CPU here, so compare ratios, not milliseconds" : ""));
    notes.push_back(
        "Ratios in words are geometric means over views, their intervals Student's over the views' logarithms.");
    return notes;
}

Json provenance_json(const RunResults& results) {
    const BuildFacts& build = build_facts();
    const Experiment& experiment = results.experiment;
    std::vector<std::string> scenes;
    for (const ExperimentScene& scene : experiment.scenes) {
        scenes.push_back(fmt::format("{} (ao within {} m, gathering within {} m, layers {} m apart)", scene.scene,
                                     scene.ao_radius, scene.indirect_radius, scene.minimum_separation));
    }
    return {{"started", results.started},
            {"took", fmt::format("{:.0f} s", results.seconds)},
            {"command", results.command},
            {"program", fmt::format("plumbline {} ({}), {} build, {}", build.version, build.git_describe,
                                    build.build_type, build.compiler)},
            {"resolution", fmt::format("{} x {}", experiment.width, experiment.height)},
            {"scenes", fmt::format("{}", fmt::join(scenes, "; "))},
            {"diffuse_bounces", experiment.quantities.bounces},
            {"ao_falloff", to_string(experiment.quantities.ao_falloff)},
            {"indirect_falloff", to_string(experiment.quantities.indirect_falloff)},
            {"truth", fmt::format("up to {} samples per pixel, target error {}, seed {}", experiment.reference.samples,
                                  experiment.reference.target_error, experiment.reference.seed)},
            {"OpenGL", fmt::format("{}, {}, {} ({})", results.gl_backend, results.gl_renderer, results.gl_version,
                                   results.gl_software ? "software" : "GPU")},
            {"Embree", results.system.embree},
            {"CPU", fmt::format("{}, {} worker threads", results.system.cpu, results.system.worker_threads)},
            {"system", results.system.operating_system}};
}

Json methods_json(const RunResults& results) {
    Json methods = Json::array();
    for (const Method& method : results.experiment.methods) {
        Method copy = method;
        Json parameters = Json::object();
        for (const MethodParameter& parameter : method_parameters(copy)) {
            const bool matters = reason_without_effect(method, parameter.name).empty();
            parameters[parameter.name] = matters ? print_parameter(parameter) : "-";
        }
        methods.push_back({{"name", method.name}, {"parameters", parameters}});
    }
    return methods;
}

// Replaces each {{name}} of the template by its value; values are not searched again.
std::string fill(std::string_view text, const std::map<std::string, std::string, std::less<>>& values) {
    std::string result;
    while (true) {
        const auto open = text.find("{{");
        if (open == std::string_view::npos) break;
        const auto close = text.find("}}", open);
        result += text.substr(0, open);
        result += values.at(std::string(text.substr(open + 2, close - open - 2)));
        text.remove_prefix(close + 2);
    }
    return result.append(text);
}

}  // namespace

std::string print_page(const RunResults& results, const std::filesystem::path& folder) {
    Json data, files = Json::object();
    data["summary"] = results.summary;
    data["notes"] = notes_json(results);
    data["failures"] = Json::array();
    for (const CellFailure& failure : results.failures) {
        data["failures"].push_back({{"cell", failure.cell}, {"message", failure.message}});
    }
    data["rows"] = rows_json(results);
    data["pictures"] = pictures_json(results, folder, files);
    data["files"] = std::move(files);
    data["colour_map"] = colour_stops();
    data["methods"] = methods_json(results);
    data["provenance"] = provenance_json(results);

    const auto part = [](std::string_view name) { return std::string(embedded::page::find(name)); };
    return fill(embedded::page::find("page.html"),
                {{"title", escape_html(results.experiment.title)},
                 {"question", escape_html(results.experiment.question)},
                 {"style", part("page.css")},
                 {"chart_library", part("chart.min.js")},
                 {"script", part("page.js")},
                 {"data", escape_for_script(data.dump(-1, ' ', false, Json::error_handler_t::replace))}});
}

std::string escape_html(std::string_view text) {
    std::string result;
    for (const char letter : text) {
        switch (letter) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            case '\'':
                result += "&#39;";
                break;
            default:
                result += letter;
        }
    }
    return result;
}

std::string escape_for_script(std::string json) {
    // Within JSON '<' stands in strings only, where an escape means the same.
    for (auto place = json.find('<'); place != std::string::npos; place = json.find('<', place))
        json.replace(place, 1, "\\u003c");
    return json;
}

}  // namespace plumb

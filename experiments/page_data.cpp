#include "experiments/page_data.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/build_facts.h"
#include "experiments/packed_plane.h"
#include "experiments/picture_look.h"
#include "experiments/run_json.h"
#include "frames/image_error.h"
#include "metrics/comparison.h"
#include "rasterizer/pass_timer.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

Json root_json(double mse) { return std::isfinite(mse) ? Json(std::sqrt(std::max(0.0, mse))) : Json(nullptr); }

Json numbers(const std::vector<double>& values) {
    Json list = Json::array();
    for (const double value : values) list.push_back(number_json(value));
    return list;
}

// In the order of measure_names().
Json measures_json(const ResultRow& row) {
    Json list = Json::array();
    for (const std::string& name : measure_names()) {
        const auto found = std::ranges::find(row.measures, name, &std::pair<std::string, double>::first);
        list.push_back(found == row.measures.end() ? Json(nullptr) : number_json(found->second));
    }
    return list;
}

Json regions_json(const ResultRow& row) {
    Json regions = Json::object();
    for (const RegionError& region : row.regions) {
        regions[region.region] = {{"pixels", region.pixels},
                                  {"rmse", region.measured ? root_json(region.mse) : Json(nullptr)},
                                  {"lower", root_json(region.mse_lower)},
                                  {"upper", root_json(region.mse_upper)}};
    }
    return regions;
}

Json stability_json(const ResultRow& row) {
    if (!row.stability) return nullptr;
    Json json = Json::object();
    for (const auto& [name, value] : row.stability->measures())
        json[name] = row.stability->tells(name) ? number_json(value) : Json(nullptr);
    return json;
}

std::string_view kind_of(const ResultRow& row) {
    return row.is_method() ? "method" : row.oracle.any() ? "oracle" : "path tracer";
}

Json page_row(const ResultRow& row) {
    const bool timed = !row.oracle.any();
    const bool has_quartiles = timed && row.timing.repetitions > 1;
    const Json none = nullptr;
    return {{"scene", row.scene},
            {"place", row.place()},
            {"is_path", !row.path.empty()},
            {"plane", row.plane},
            {"truth", row.truth},
            {"method", row.method},
            {"kind", kind_of(row)},
            {"samples", row.path_tracer_samples},
            {"curve", row.curve},
            {"curve_value", row.curve_value},
            {"measured", row.measured},
            {"refusal", row.refusal},
            {"rmse", row.measured ? number_json(row.rmse()) : none},
            {"rmse_lower", number_json(row.rmse_lower())},
            {"rmse_upper", number_json(row.rmse_upper())},
            {"psnr", row.measured ? number_json(row.psnr) : none},
            {"ssim", row.measured ? number_json(row.ssim) : none},
            {"noise", root_json(row.noise_mse)},
            {"measures", measures_json(row)},
            {"regions", regions_json(row)},
            {"stability", stability_json(row)},
            {"milliseconds", timed ? number_json(row.timing.median) : none},
            {"milliseconds_lower", has_quartiles ? number_json(row.timing.lower_quartile) : none},
            {"milliseconds_upper", has_quartiles ? number_json(row.timing.upper_quartile) : none},
            {"bytes", row.gbuffer_bytes_per_pixel}};
}

// How the script turns a plane into colours: as picture_of_plane does for files.
std::string_view display_of(std::string_view plane) {
    const std::string_view name = plane.substr(plane.rfind('.') + 1);
    if (name == "ao" || name == "alpha") return "scalar";
    if (name == "depth") return "depth";
    if (name == "normal") return "vectors";
    if (name == "motion" || name == "position") return "scaled vectors";
    return "radiance";
}

// Collects the files that the page contains, as long as there is room.
class Pictures {
public:
    Pictures(const std::filesystem::path& folder, PageData& data) : folder_(folder), data_(data) {}

    Json sets(const std::vector<PictureSet>& sets) {
        Json list = Json::array();
        for (const PictureSet& set : sets) {
            std::vector<std::string> files;
            for (const Picture& picture : set.images) {
                if (picture.kind != "error") files.push_back(values_of(picture));
            }
            std::erase_if(files, [&](const std::string& file) { return place_of(file) < data_.planes.size(); });
            if (!has_room(files)) continue;
            data_.planes.insert(data_.planes.end(), files.begin(), files.end());
            list.push_back(set_json(set));
        }
        return list;
    }

    Json paths(const std::vector<PathPictures>& paths) {
        Json list = Json::array();
        for (const PathPictures& path : paths) {
            std::vector<std::string> files;
            for (const PathPictureStrip& strip : path.strips) {
                files.insert(files.end(), strip.files.begin(), strip.files.end());
            }
            if (has_room(files)) list.push_back(path_json(path));
        }
        return list;
    }

    // What a reader should know of pictures that are not here; empty where all are.
    std::string left_off() const {
        if (left_off_ == 0) return "";
        return fmt::format(
            "{} of {} sets of pictures are left off: with them this page would exceed {} MB. Their files lie in "
            "the folder 'pictures' beside it.",
            left_off_, sets_, most_picture_bytes / 1'000'000);
    }

private:
    static const std::string& values_of(const Picture& picture) {
        if (!picture.values.empty()) return picture.values;
        throw ImageError(
            fmt::format("picture '{}' has no packed plane beside it; write the pictures again", picture.file));
    }

    std::size_t place_of(const std::string& file) const {
        return static_cast<std::size_t>(std::ranges::find(data_.planes, file) - data_.planes.begin());
    }

    bool has_room(const std::vector<std::string>& files) {
        ++sets_;
        std::uintmax_t bytes = bytes_;
        for (const std::string& file : files) {
            std::error_code error;
            const auto size = std::filesystem::file_size(folder_ / file, error);
            if (error) {
                throw ImageError(fmt::format("cannot read '{}', which belongs on the page: {}",
                                             (folder_ / file).string(), error.message()));
            }
            bytes += size + size / 3;  // in base64
        }
        const bool room = bytes <= most_picture_bytes;
        if (room)
            bytes_ = bytes;
        else
            ++left_off_;
        return room;
    }

    Json set_json(const PictureSet& set) const {
        Json images = Json::array();
        for (const Picture& picture : set.images) {
            if (picture.kind == "error") continue;  // the script makes them of the values
            images.push_back({{"label", picture.label},
                              {"kind", picture.kind},
                              {"values", place_of(picture.values)},
                              {"note", picture.note}});
        }
        return {{"scene", set.scene},
                {"view", set.view},
                {"plane", set.plane},
                {"truth", set.truth},
                {"display", display_of(set.plane)},
                {"exposure", display_of(set.plane) == "radiance" ? set.exposure : 0.0f},
                {"error_scale", set.error_scale},
                {"images", images}};
    }

    Json path_json(const PathPictures& path) {
        Json strips = Json::array();
        for (const PathPictureStrip& strip : path.strips) {
            strips.push_back({{"label", strip.label},
                              {"kind", strip.kind},
                              {"frames", data_.strips.size()},
                              {"count", strip.files.size()},
                              {"rmse", numbers(strip.rmse)},
                              {"flicker", numbers(strip.flicker)}});
            data_.strips.push_back(strip.files);
        }
        return {{"scene", path.scene},
                {"path", path.path},
                {"plane", path.plane},
                {"truth", path.truth},
                {"frames_per_second", path.frames_per_second},
                {"error_scale", path.error_scale},
                {"exposure_note", path.exposure_note},
                {"strips", strips}};
    }

    const std::filesystem::path& folder_;
    PageData& data_;
    std::uintmax_t bytes_ = 0;
    int sets_ = 0, left_off_ = 0;
};

Json waterfalls_json(const RunResults& results) {
    Json list = Json::array();
    for (const Waterfall& waterfall : results.waterfalls) {
        Json bars = Json::array();
        for (const WaterfallBar& bar : waterfall.bars) {
            bars.push_back({{"label", bar.label},
                            {"from", number_json(bar.from)},
                            {"to", number_json(bar.to)},
                            {"lower", number_json(bar.change_lower)},
                            {"upper", number_json(bar.change_upper)},
                            {"note", bar.note}});
        }
        list.push_back({{"title", waterfall.title}, {"axis", waterfall.axis}, {"bars", bars}});
    }
    return list;
}

// Equally spaced colours of a map, close enough that straight lines between them are the map.
Json colour_stops(ColourMap map) {
    constexpr int last = 40;
    Json stops = Json::array();
    for (int i = 0; i <= last; ++i) {
        const auto colour = colour_at(map, static_cast<float>(i) / last);
        std::string text = "#";
        for (const float level : colour) text += fmt::format("{:02x}", std::lround(255.0f * level));
        stops.push_back(text);
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
        "{} frames, methods taking turns; each pass is timed by {}{}.",
        experiment.timing.warm_up, experiment.timing.repetitions, timer_description(results.gl_software),
        results.gl_software ? "; OpenGL ran on the CPU here, so compare ratios, not milliseconds" : ""));
    notes.push_back(
        "Ratios in words are geometric means over views, their intervals Student's over the views' logarithms.");
    if (!results.path_pictures.empty()) {
        notes.push_back(
            "Flicker is the RMS, over pixels seen in two frames that follow each other, of how the error changed "
            "from the one to the other along the surfaces' motion; what the truth itself does cancels. It is left out "
            "where the truth's noise is too near to it.");
    }
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

}  // namespace

PageData page_data(const RunResults& results, const std::filesystem::path& folder) {
    PageData data;
    Json json;
    json["summary"] = results.summary;
    json["notes"] = notes_json(results);
    json["failures"] = Json::array();
    for (const CellFailure& failure : results.failures) {
        json["failures"].push_back({{"cell", failure.cell}, {"message", failure.message}});
    }
    json["measure_names"] = measure_names();
    json["rows"] = Json::array();
    for (const ResultRow& row : results.rows) json["rows"].push_back(page_row(row));
    Pictures pictures(folder, data);
    json["pictures"] = pictures.sets(results.pictures);
    json["paths"] = pictures.paths(results.path_pictures);
    json["left_off"] = pictures.left_off();
    json["waterfalls"] = waterfalls_json(results);
    json["precision"] = packed_plane_precision;
    json["colour_maps"] = {{"error", colour_stops(error_colour_map)}, {"signed", colour_stops(ColourMap::diverging)}};
    json["methods"] = methods_json(results);
    json["provenance"] = provenance_json(results);
    data.json = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return data;
}

}  // namespace plumb

#include "experiments/measurements.h"

#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

Json cell_json(const Cell& cell) {
    Json json = {{"scene", cell.scene}, {"place", cell.place},   {"plane", cell.plane},
                 {"truth", cell.truth}, {"method", cell.method}, {"curve", cell.curve}};
    if (!std::isnan(cell.parameter)) json["parameter"] = cell.parameter;
    // Pairs, not members: names may repeat where two passes share one.
    json["values"] = Json::array();
    for (const auto& [name, value] : cell.values) json["values"].push_back({name, value});
    return json;
}

Cell cell_of(const Json& json) {
    Cell cell{json.at("scene"), json.at("place"),  json.at("plane"),
              json.at("truth"), json.at("method"), json.at("curve")};
    if (json.contains("parameter")) cell.parameter = json.at("parameter");
    for (const Json& value : json.at("values")) cell.set(value.at(0), value.at(1));
    return cell;
}

Json picture_set_json(const PictureSet& set) {
    Json json = {{"scene", set.scene},
                 {"view", set.view},
                 {"plane", set.plane},
                 {"truth", set.truth},
                 {"error_scale", set.error_scale}};
    json["images"] = Json::array();
    for (const Picture& picture : set.images)
        json["images"].push_back({{"label", picture.label}, {"kind", picture.kind}, {"file", picture.file}});
    return json;
}

PictureSet picture_set_of(const Json& json) {
    PictureSet set;
    set.scene = json.at("scene"), set.view = json.at("view"), set.plane = json.at("plane");
    set.truth = json.at("truth"), set.error_scale = json.at("error_scale");
    for (const Json& image : json.at("images")) {
        Picture picture;
        picture.label = image.at("label"), picture.kind = image.at("kind"), picture.file = image.at("file");
        set.images.push_back(std::move(picture));
    }
    return set;
}

}  // namespace

std::string print_measurements_json(const Measurements& measurements) {
    Json json = {{"experiment", measurements.experiment},
                 {"command", measurements.command},
                 {"started", measurements.started},
                 {"renderer", measurements.renderer},
                 {"cpu", measurements.cpu},
                 {"seconds", measurements.seconds},
                 {"quick", measurements.quick},
                 {"program", measurements.program},
                 {"key", measurements.key},
                 {"left_out", measurements.left_out},
                 {"failures", Json::array()},
                 {"pictures", Json::array()},
                 {"cells", Json::array()}};
    for (const CellFailure& failure : measurements.failures)
        json["failures"].push_back({{"cell", failure.cell}, {"message", failure.message}});
    for (const PictureSet& set : measurements.pictures) json["pictures"].push_back(picture_set_json(set));
    for (const Cell& cell : measurements.cells) json["cells"].push_back(cell_json(cell));
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Measurements read_measurements_json(const std::filesystem::path& file) {
    std::ifstream stream(file);
    try {
        const Json json = Json::parse(stream);
        Measurements measurements;
        measurements.experiment = json.at("experiment"), measurements.command = json.at("command");
        measurements.started = json.at("started"), measurements.renderer = json.at("renderer");
        measurements.cpu = json.at("cpu"), measurements.seconds = json.at("seconds");
        measurements.program = json.value("program", "");
        measurements.key = json.value("key", "");  // none in files of programs that kept none
        measurements.quick = json.at("quick"), measurements.left_out = json.at("left_out");
        for (const Json& failure : json.at("failures"))
            measurements.failures.push_back({failure.at("cell"), failure.at("message")});
        for (const Json& set : json.at("pictures")) measurements.pictures.push_back(picture_set_of(set));
        for (const Json& cell : json.at("cells")) measurements.cells.push_back(cell_of(cell));
        return measurements;
    } catch (const Json::exception& error) {
        throw ConfigError(
            fmt::format("'{}' holds no measurements of a reproduction ({}); run 'plumbline reproduce' "
                        "without --present first",
                        file.string(), error.what()));
    }
}

}  // namespace plumb

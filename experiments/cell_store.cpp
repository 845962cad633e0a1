#include "experiments/cell_store.h"

#include <exception>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/frame_checksum.h"
#include "experiments/program_checksum.h"
#include "frames/exr.h"
#include "frames/image_error.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

// Planes are named by their place in the cell: the same plane occurs once per method.
std::string name_of(std::size_t index, std::string_view part = "") { return fmt::format("cell{}{}", index, part); }
std::string seed_part(std::size_t seed) { return fmt::format("s{}", seed); }

Json json_of(const PlaneImage& image) {
    Json passes = Json::array();
    for (const PassTiming& pass : image.timing.passes) passes.push_back({pass.pass, pass.milliseconds});
    return {{"view", image.view},
            {"plane", image.plane},
            {"method", image.method},
            {"path_tracer_samples", image.path_tracer_samples},
            {"oracle", {image.oracle.layers, image.oracle.bounces}},
            {"other_seeds", image.other_seeds.size()},
            {"bytes", image.gbuffer_bytes_per_pixel},
            {"timing", {image.timing.median, image.timing.lower_quartile, image.timing.upper_quartile}},
            {"repetitions", image.timing.repetitions},
            {"passes", passes}};
}

PlaneImage image_of(const Json& json) {
    PlaneImage image;
    image.view = json.at("view"), image.plane = json.at("plane"), image.method = json.at("method");
    image.path_tracer_samples = json.at("path_tracer_samples");
    image.oracle = {json.at("oracle").at(0), json.at("oracle").at(1)};
    image.gbuffer_bytes_per_pixel = json.at("bytes");
    const Json& timing = json.at("timing");
    image.timing = {timing.at(0), timing.at(1), timing.at(2), json.at("repetitions"), {}};
    for (const Json& pass : json.at("passes")) image.timing.passes.push_back({pass.at(0), pass.at(1)});
    return image;
}

}  // namespace

CellStore::CellStore(std::filesystem::path folder) : folder_(std::move(folder)), program_(program_checksum()) {}

std::filesystem::path CellStore::file_of(const std::string& key) const {
    return folder_ / (text_checksum(key) + ".exr");
}

std::optional<std::vector<PlaneImage>> CellStore::load(const std::string& key) const {
    const std::filesystem::path file = file_of(key);
    if (!std::filesystem::exists(file)) return std::nullopt;
    try {
        Frame frame = read_exr(file);
        const bool ours = frame.facts["cell.key"] == key && frame.facts["cell.program"] == program_;
        if (!ours || frame.facts["cell.checksum"] != frame_checksum(frame)) return std::nullopt;
        std::vector<PlaneImage> images;
        for (const Json& entry : Json::parse(frame.facts["cell.images"])) {
            const std::size_t index = images.size();
            PlaneImage& image = images.emplace_back(image_of(entry));
            image.image = std::move(frame.plane(name_of(index)));
            for (std::size_t seed = 0; seed < entry.at("other_seeds").get<std::size_t>(); ++seed)
                image.other_seeds.push_back(std::move(frame.plane(name_of(index, seed_part(seed)))));
            if (frame.has(name_of(index, "a"))) {
                image.halves = {std::move(frame.plane(name_of(index, "a"))),
                                std::move(frame.plane(name_of(index, "b")))};
            }
        }
        return images;
    } catch (const std::exception&) {
        return std::nullopt;  // a cell that cannot be read is rendered again, which costs time only
    }
}

void CellStore::save(const std::string& key, const std::vector<PlaneImage>& images) const {
    if (images.empty()) return;
    Frame frame(images.front().image.width(), images.front().image.height());
    Json entries = Json::array();
    for (std::size_t i = 0; i < images.size(); ++i) {
        entries.push_back(json_of(images[i]));
        frame.set(name_of(i), images[i].image);
        for (std::size_t seed = 0; seed < images[i].other_seeds.size(); ++seed)
            frame.set(name_of(i, seed_part(seed)), images[i].other_seeds[seed]);
        if (!images[i].halves) continue;
        frame.set(name_of(i, "a"), images[i].halves->a);
        frame.set(name_of(i, "b"), images[i].halves->b);
    }
    frame.facts = {{"cell.key", key},
                   {"cell.program", program_},
                   {"cell.checksum", frame_checksum(frame)},
                   {"cell.images", entries.dump(-1, ' ', true, Json::error_handler_t::replace)}};
    std::filesystem::create_directories(folder_);
    write_exr(file_of(key), frame);
}

void CellStore::clear() const {
    std::error_code ignored;  // what is left behind costs space only
    std::filesystem::remove_all(folder_, ignored);
}

}  // namespace plumb

#include "scenes/gltf_extras.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/scene_error.h"

namespace plumb {
namespace {

constexpr std::array<std::string_view, 2> understood = {"KHR_lights_punctual", "KHR_materials_emissive_strength"};

// The JSON of a .gltf as it is, of a .glb out of its first chunk: after 12 bytes of header its length, "JSON", its
// bytes.
std::string json_text(const std::filesystem::path& file) {
    std::ifstream input(file, std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(input), {});
    if (!bytes.starts_with("glTF")) return bytes;
    std::uint32_t length = 0;
    if (bytes.size() >= 20) std::memcpy(&length, bytes.data() + 12, sizeof length);
    if (length == 0 || 20 + static_cast<std::size_t>(length) > bytes.size()) {
        throw SceneError(fmt::format("'{}' is cut short: its JSON chunk is not whole; fetch it again", file.string()));
    }
    return bytes.substr(20, length);
}

}  // namespace

GltfExtras read_gltf_extras(const std::filesystem::path& file) {
    using nlohmann::json;
    GltfExtras extras;
    try {
        const json document = json::parse(json_text(file));
        const auto list = [&](const char* key) { return document.value(key, json::array()); };
        for (const json& material : list("materials")) {
            const json extensions = material.value("extensions", json::object());
            const json strength = extensions.value("KHR_materials_emissive_strength", json::object());
            extras.emissive_strengths.push_back(strength.value("emissiveStrength", 1.0f));
            extras.has_normal_maps = extras.has_normal_maps || material.contains("normalTexture");
        }
        for (const json& camera : list("cameras")) {
            const json perspective = camera.value("perspective", json::object());
            if (perspective.contains("yfov")) {
                extras.vertical_fovs.emplace_back(perspective.at("yfov").get<float>());
            } else {
                extras.vertical_fovs.emplace_back(std::nullopt);
            }
        }
        for (const json& extension : list("extensionsUsed")) {
            const auto name = extension.get<std::string>();
            if (std::ranges::find(understood, name) == understood.end()) extras.ignored_extensions.push_back(name);
        }
    } catch (const json::exception& error) {
        throw SceneError(fmt::format("'{}' is not valid glTF: {}; export it again", file.string(), error.what()));
    }
    return extras;
}

}  // namespace plumb

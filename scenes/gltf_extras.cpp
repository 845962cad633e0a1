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

constexpr std::array<std::string_view, 5> understood = {"KHR_lights_punctual", "KHR_materials_emissive_strength",
                                                        "KHR_materials_ior", "KHR_materials_specular",
                                                        "KHR_materials_transmission"};

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

GltfMaterial read_material(const nlohmann::json& material, GltfExtras& extras) {
    using nlohmann::json;
    const json extensions = material.value("extensions", json::object());
    const auto extension = [&](const char* name) { return extensions.value(name, json::object()); };
    const json specular = extension("KHR_materials_specular"), transmission = extension("KHR_materials_transmission");
    extras.has_normal_maps = extras.has_normal_maps || material.contains("normalTexture");
    extras.has_specular_maps =
        extras.has_specular_maps || specular.contains("specularTexture") || specular.contains("specularColorTexture");
    extras.has_transmission_maps = extras.has_transmission_maps || transmission.contains("transmissionTexture");
    GltfMaterial result;
    result.emissive_strength = extension("KHR_materials_emissive_strength").value("emissiveStrength", 1.0f);
    result.transmission = std::clamp(transmission.value("transmissionFactor", 0.0f), 0.0f, 1.0f);
    // Fresnel's reflectance at normal incidence; an index of 0 stands for 1, as that extension says.
    const float index = extension("KHR_materials_ior").value("ior", 1.5f);
    const float root = (index - 1.0f) / (index + 1.0f);
    const auto colour = specular.value("specularColorFactor", std::array<float, 3>{1.0f, 1.0f, 1.0f});
    const float luminance = 0.2126f * colour[0] + 0.7152f * colour[1] + 0.0722f * colour[2];
    result.dielectric_reflectance =
        std::min(root * root * luminance, 1.0f) * std::clamp(specular.value("specularFactor", 1.0f), 0.0f, 1.0f);
    return result;
}

}  // namespace

GltfExtras read_gltf_extras(const std::filesystem::path& file) {
    using nlohmann::json;
    GltfExtras extras;
    try {
        const json document = json::parse(json_text(file));
        const auto list = [&](const char* key) { return document.value(key, json::array()); };
        for (const json& material : list("materials")) {
            extras.materials.push_back(read_material(material, extras));
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

// What a glTF file says and Assimp does not hand on.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumb {

struct GltfMaterial {
    float emissive_strength = 1.0f;       // KHR_materials_emissive_strength
    float dielectric_reflectance = 0.0f;  // of KHR_materials_ior and KHR_materials_specular, the colour's luminance
    float transmission = 0.0f;            // KHR_materials_transmission
};

struct GltfExtras {
    std::vector<GltfMaterial> materials;
    std::vector<std::optional<float>> vertical_fovs;  // radians, one per camera; none: not a perspective camera
    std::vector<std::string> ignored_extensions;      // used, but of no meaning here
    bool has_normal_maps = false;
    bool has_specular_maps = false, has_transmission_maps = false;
};

// Of a .gltf or .glb file. Throws SceneError where it is no glTF.
GltfExtras read_gltf_extras(const std::filesystem::path& file);

}  // namespace plumb

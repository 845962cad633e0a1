// What a glTF file says and Assimp does not hand on.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumb {

struct GltfExtras {
    std::vector<float> emissive_strengths;            // KHR_materials_emissive_strength, one per material
    std::vector<std::optional<float>> vertical_fovs;  // radians, one per camera; none: not a perspective camera
    std::vector<std::string> ignored_extensions;      // used, but of no meaning here
    bool has_normal_maps = false;
};

// Of a .gltf or .glb file. Throws SceneError where it is no glTF.
GltfExtras read_gltf_extras(const std::filesystem::path& file);

}  // namespace plumb

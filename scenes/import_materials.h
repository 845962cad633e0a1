// The materials and textures of an imported file. Part of scenes/import.cpp; see scenes/import.h for the decisions.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/import.h"
#include "scenes/scene.h"

struct aiScene;

namespace plumb {

struct GltfExtras;

// Appends to `scene` one material for each of the file's, the textures that they need, and import notes. Returns which
// materials' triangles are to be left out. `extras` is null unless the file is glTF.
std::vector<bool> import_materials(const aiScene& source, const std::filesystem::path& file, const GltfExtras* extras,
                                   const ImportOptions& options, Scene& scene);

}  // namespace plumb

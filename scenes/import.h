// Scenes from files: glTF 2.0, OBJ with MTL, PLY, 3DS, and whatever else Assimp reads.
//
// What is taken: triangles (polygons are cut by ear clipping; lines and points are dropped), normals, the first UVs,
// instances, materials as scenes/material.h has them, textures beside the file or embedded; from glTF also cameras and
// the lights of KHR_lights_punctual. What is left out or changed on the way in is said in Scene::import_notes.
//
// Decisions:
//   glTF light units: one candela, lux or nit counts as one W/sr, W/m^2 or W/(m^2 sr): lights and emission keep their
//   ratio. glTF alphaMode BLEND: opaque where the material's own alpha is at least 0.5 or varies in a texture, which
//   then masks at
//     0.5; a material whose factor alone is below 0.5 (glass) is left out. MTL `d` below 0.5 alike; map_d masks at 0.5.
//   glTF doubleSided: false means one-sided, as that format says. All other formats: two-sided, emitters too.
//   MTL: Kd is the base colour; where Kd is black and Ks is not, a metal of colour Ks; Ns gives the roughness where Ks
//   > 0. Normal maps, occlusion maps and vertex colours are not used.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace plumb {

enum class NormalSource {
    file,    // as the file has them; face normals where it has none
    face,    // face normals
    smooth,  // made anew, edges sharper than the crease angle stay sharp
};

struct ImportOptions {
    float scale = 1.0f;  // metres per unit of the file
    NormalSource normals = NormalSource::file;
    float crease_angle = 1.0471976f;          // radians (60 degrees), for NormalSource::smooth
    std::vector<std::string> drop_materials;  // triangles of these materials are left out; unknown names are errors
    // File names (without folders) of textures whose rows are stored bottom row first, as some TGA converters leave
    // them; names that no material in the file uses are errors.
    std::vector<std::string> upside_down_textures;
    bool flip_winding = false;  // turns every triangle and normal round
    // Exporters write a grey Kd (0.588 from 3ds Max) under every texture, which a strict reader multiplies with it and
    // so darkens the whole scene. True: a texture stands alone.
    bool ignore_diffuse_colour_under_texture = false;
};

// The scene in `file`, repaired (scenes/repair.h) and valid (scenes/validate.h). Throws SceneError that names the file,
// the element and the remedy where nothing sensible can be made of it.
Scene import_scene_file(const std::filesystem::path& file, const ImportOptions& options = {});

}  // namespace plumb

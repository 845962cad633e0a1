// Scenes from files: glTF 2.0, OBJ with MTL, PLY, 3DS, and whatever else Assimp reads.
//
// What is taken: triangles (polygons are cut by ear clipping; lines and points are dropped), normals, the first UVs,
// instances, materials as scenes/material.h has them, textures beside the file or embedded; from glTF also cameras and
// the lights of KHR_lights_punctual. What is left out or changed on the way in is said in Scene::import_notes.
//
// Decisions:
//   glTF light units: one candela, lux or nit counts as one W/sr, W/m^2 or W/(m^2 sr): lights and emission keep their
//   ratio.
//   Specular lobes: glTF's dielectrics reflect 0.04, or what KHR_materials_ior and KHR_materials_specular say, whose
//     colour counts by its luminance. Other formats have none but metals, unless `specular` is set.
//   Transparency is that of thin sheets, without refraction. Coverage a, from glTF's alphaMode BLEND or MTL's d (Tr):
//     transmission 1 - a, times MTL's Tf; base colour and emission times a. Tf alone says nothing: exporters write
//     Tf 1 1 1 for everything. KHR_materials_transmission lets factor * base colour through its dielectric part. An
//     image of alpha that has holes somewhere (alpha below 0.1) is a mask at 0.5 that says where there is a surface;
//     one that has none is a pane and counts by its mean. MTL's map_d is always a mask. A coverage of 0 is left out.
//   glTF doubleSided: false means one-sided, as that format says. All other formats: two-sided, emitters too.
//   MTL: Kd is the base colour; where Kd is black and Ks is not, a metal of colour Ks, unless transparent; Ns gives the
//   roughness where Ks > 0. Normal maps, occlusion maps and vertex colours are not used.
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
    // MTL leaves open what Ks means. True: a specular lobe of reflectance luminance(Ks), or that of Ni where the
    // material is transparent; mirrors (illum 3, 5, 8 with Ks brighter than Kd) are metals of colour Ks; illum 0 has
    // none. Ns is Blinn-Phong's exponent; from 1000, the largest one, and under illum 3 and more there is no roughness.
    // False: no lobes but metals'.
    bool specular = false;
    std::vector<std::string> keep_apart;  // names of nodes or groups that are to stay instances of their own
};

// The scene in `file`, repaired (scenes/repair.h) and valid (scenes/validate.h). Throws SceneError that names the file,
// the element and the remedy where nothing sensible can be made of it.
Scene import_scene_file(const std::filesystem::path& file, const ImportOptions& options = {});

}  // namespace plumb

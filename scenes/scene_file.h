// Loads a scene by name or path: built in, described by a TOML file, or a mesh file as it is.
//
// A TOML scene file wraps a mesh file with what that one lacks. All keys but `mesh` are optional; lengths are metres of
// the scaled scene, angles degrees, colours and light linear; a single number stands for three equal ones.
//
//     mesh = "crytek-sponza/sponza.obj"     # beside this file, or in one of the scene folders; or: builtin = "cornell"
//     name = "sponza"                       # else the TOML file's name
//     description = "one line"
//     [import]
//     scale = 0.01                          # metres per unit of the mesh file
//     normals = "file"                      # "file", "face" or "smooth"
//     crease_angle = 60.0                   # for "smooth": edges sharper than this stay sharp
//     drop_materials = ["banner"]
//     upside_down_textures = ["lion.jpg"]   # stored bottom row first
//     flip_winding = false
//     ignore_diffuse_colour_under_texture = false
//     [materials."brick"]                   # overrides; the name must exist
//     base_colour = [0.7, 0.6, 0.5]         # also: metallic, roughness, emission, two_sided
//     [ground]                              # a level two-sided square under an object that has none; all keys optional
//     height = 0.0                          # also: centre = [x, any, z], size (metres, its side), base_colour
//     [environment]
//     radiance = [0.5, 0.6, 0.9]            # multiplies the image
//     image = "environment/sky.hdr"         # equirectangular; found as the mesh is
//     rotation = 0.0
//     [[point_lights]]                      # name, position, intensity (W/sr)
//     [[spot_lights]]                       # name, position, direction or target, intensity, inner_angle, outer_angle
//     (half angles)
//     [[directional_lights]]                # name, direction, irradiance
//     [[views]]                             # name, eye, target, up, vertical_fov, near, far
//     [[paths]]                             # name, vertical_fov, near, far, keys = [{time = 0.0, eye = [..], target =
//     [..]}, ..]
//
// Views and paths of the mesh file are kept, those of the same name replaced. Lights are added to the mesh file's.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace plumb {

// Names of the scene descriptions that are part of the program for well-known meshes, which are not.
std::vector<std::string> wrapper_scene_names();

// `name_or_path`: the name of a built-in scene or of a wrapper, or the path of a .toml or mesh file; a relative path is
// looked for in the current folder, then in `scenes_dirs`. A scene without a view gets one from outside its bounds, one
// without any light a constant environment of radiance 1; import notes say so. Throws SceneError.
Scene load_scene(const std::string& name_or_path, const std::vector<std::filesystem::path>& scenes_dirs = {});

// The same for a TOML text; `file` names it in messages, meshes are looked for beside it first.
Scene load_scene_text(std::string_view text, const std::filesystem::path& file,
                      const std::vector<std::filesystem::path>& scenes_dirs = {});

// The folders in the environment variable PLUMBLINE_SCENES, separated by colons.
std::vector<std::filesystem::path> scenes_dirs_of_environment();

}  // namespace plumb

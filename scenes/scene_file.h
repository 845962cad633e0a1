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
//     specular = false                      # true: MTL's Ks and Ns make specular lobes (scenes/import.h)
//     [materials."brick"]                   # overrides; the name must exist
//     base_colour = [0.7, 0.6, 0.5]         # also: metallic, roughness, dielectric_reflectance,
//                                           # transmission, emission, two_sided
//     [ground]                              # a level two-sided square under an object that has none; all keys optional
//     height = 0.0                          # also: centre = [x, any, z], size (metres, its side), base_colour
//     [environment]
//     radiance = [0.5, 0.6, 0.9]            # multiplies the image
//     image = "environment/sky.hdr"         # equirectangular; found as the mesh is
//     rotation = 0.0
//     [[point_lights]]                      # name, position, intensity (W/sr), attenuation
//     attenuation = { constant = 0.0, linear = 0.0, quadratic = 1.0 }
//     [[spot_lights]]                       # name, position, direction or target, intensity, inner_angle, outer_angle
//                                           # (half angles), attenuation
//     [[directional_lights]]                # name, direction, irradiance, angular_radius (0: parallel; the sun: 0.266)
//     [[views]]                             # name, eye, target, up, vertical_fov, near, far, aperture_radius (0: a
//                                           # pinhole), focus_distance (else that of the target)
//     [[paths]]                             # name, vertical_fov, near, far, aperture_radius, focus_distance (alike)
//     keys = [{ time = 0.0, eye = [0, 1, 4], target = [0, 1, 0] }, { time = 2.0, ... }]
//     [[motions]]
//     instance = "fan"                      # all instances of this name move together
//     interpolation = "smooth"              # or "linear"
//     pivot = [0, 2, 0]                     # rotation and scale are about it; else the centre of their bounds
//     keys = [{ time = 0.0 }, { time = 2.0, translation = [0, 0, 1], axis = [0, 1, 0], angle = 120.0, scale = 1.0 }]
//
// Views and paths of the mesh file are kept, those of the same name replaced. Lights are added to the mesh file's. Keys
// of a motion are relative to where the object stands otherwise; a loaded scene stands at time 0. Instances are named
// as the nodes or groups of the mesh file; those of one material that nothing moves are joined under its name.
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

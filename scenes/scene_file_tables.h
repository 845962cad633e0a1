// What a scene file says of materials, lights, cameras and motion. Part of scenes/scene_file.cpp; see
// scenes/scene_file.h for the keys.
#pragma once

#include "scenes/scene.h"

namespace plumb {

class TomlReader;

// Each takes its tables out of the whole file's reader. Throws SceneError with file and line.
void read_materials(TomlReader& scene_file, Scene& scene);  // overrides what the scene has
void read_lights(TomlReader& scene_file, Scene& scene);     // added
void read_views(TomlReader& scene_file, Scene& scene);      // added, or in place of those of the same name
void read_paths(TomlReader& scene_file, Scene& scene);      // alike
void read_motions(TomlReader& scene_file, Scene& scene);    // moves the scene to time 0

// The instances that [[motions]] moves, which an importer must not join with others.
std::vector<std::string> moving_instances(TomlReader& scene_file);

}  // namespace plumb

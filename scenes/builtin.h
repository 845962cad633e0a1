// Scenes made by code, so that the program is useful with no file at all.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace plumb {

// The measured Cornell box (Cornell University Program of Computer Graphics, "Cornell Box Data"), in metres.
Scene make_cornell();
// An atrium with columns, arches, vaults, curtains, masked grilles and plants under the open sky; what Sponza shows.
Scene make_colonnade();
// A room full of thin gaps and of occluders just off its walls, where one depth layer fails.
Scene make_clutter();

// Names of all built-in scenes.
std::vector<std::string> builtin_scene_names();
// Throws SceneError that lists the names there are.
Scene make_builtin_scene(std::string_view name);

}  // namespace plumb

#include "scenes/builtin.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/scene_error.h"

namespace plumb {

std::vector<std::string> builtin_scene_names() { return {"cornell"}; }

Scene make_builtin_scene(std::string_view name) {
    if (name == "cornell") return make_cornell();
    throw SceneError(fmt::format("no built-in scene '{}'; there are: {}", name, fmt::join(builtin_scene_names(), ", ")));
}

}  // namespace plumb

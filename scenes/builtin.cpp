#include "scenes/builtin.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/scene_error.h"

namespace plumb {

namespace {

struct Builtin {
    const char* name;
    Scene (*make)();
};
constexpr Builtin builtins[] = {{"cornell", make_cornell}, {"colonnade", make_colonnade}, {"clutter", make_clutter}};

}  // namespace

std::vector<std::string> builtin_scene_names() {
    std::vector<std::string> names;
    for (const Builtin& builtin : builtins) names.push_back(builtin.name);
    return names;
}

Scene make_builtin_scene(std::string_view name) {
    for (const Builtin& builtin : builtins) {
        if (name == builtin.name) return builtin.make();
    }
    throw SceneError(
        fmt::format("no built-in scene '{}'; there are: {}", name, fmt::join(builtin_scene_names(), ", ")));
}

}  // namespace plumb

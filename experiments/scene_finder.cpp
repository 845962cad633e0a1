#include "experiments/scene_finder.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include "experiments/config.h"
#include "scenes/builtin.h"
#include "scenes/scene_error.h"

namespace plumb {
namespace {

void add_scene_files(const std::filesystem::path& folder, std::vector<FoundScene>& found) {
    std::error_code ignored;  // a folder that cannot be read has no scenes to offer
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        if (entry.path().extension() == ".toml") found.push_back({entry.path().stem().string(), entry.path()});
    }
}

}  // namespace

SceneFinder::SceneFinder(std::filesystem::path scenes_dir) : scenes_dir_(std::move(scenes_dir)) {}

std::vector<FoundScene> SceneFinder::list() const {
    std::vector<FoundScene> found;
    for (const std::string& name : builtin_scene_names()) found.push_back({name, {}});
    if (scenes_dir_.empty()) return found;
    if (!std::filesystem::is_directory(scenes_dir_)) {
        throw SceneError(
            fmt::format("scenes folder '{}' (--scenes-dir or PLUMBLINE_SCENES) does not exist", scenes_dir_.string()));
    }
    std::vector<FoundScene> files;
    add_scene_files(scenes_dir_, files);
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(scenes_dir_, ignored)) {
        if (entry.is_directory(ignored)) add_scene_files(entry.path(), files);
    }
    std::ranges::sort(files, {}, &FoundScene::name);
    found.insert(found.end(), files.begin(), files.end());
    return found;
}

Scene SceneFinder::load(const std::string& name_or_path) const {
    const auto builtin = builtin_scene_names();
    if (std::ranges::find(builtin, name_or_path) != builtin.end()) return make_builtin_scene(name_or_path);
    std::vector<std::string> names;
    for (const FoundScene& scene : list()) names.push_back(scene.name);
    throw SceneError(fmt::format("scene '{}': neither a file nor a scene that is known here; {}", name_or_path,
                                 name_hint(name_or_path, names)));
}

const Camera& choose_camera(const Scene& scene, const std::string& name) {
    if (!name.empty()) return scene.camera(name);
    if (scene.cameras.empty())
        throw SceneError(fmt::format("scene '{}' has no view; add one to its scene file", scene.name));
    return scene.cameras.front();
}

}  // namespace plumb

#include "experiments/scene_finder.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include "experiments/config.h"
#include "scenes/builtin.h"
#include "scenes/scene_error.h"
#include "scenes/scene_file.h"

namespace plumb {
namespace {

void add_scene_files(const std::filesystem::path& folder, std::vector<FoundScene>& found) {
    std::error_code ignored;  // a folder that cannot be read has no scenes to offer
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        if (entry.path().extension() == ".toml") found.push_back({entry.path().string(), "file"});
    }
}

}  // namespace

SceneFinder::SceneFinder(std::vector<std::filesystem::path> scenes_dirs) : scenes_dirs_(std::move(scenes_dirs)) {}

std::vector<FoundScene> SceneFinder::list() const {
    std::vector<FoundScene> found;
    for (const std::string& name : builtin_scene_names()) found.push_back({name, "built in"});
    for (const std::string& name : wrapper_scene_names()) found.push_back({name, "wrapper"});
    std::vector<FoundScene> files;
    for (const auto& folder : scenes_dirs_) {
        if (!std::filesystem::is_directory(folder)) {
            throw SceneError(
                fmt::format("scenes folder '{}' (--scenes-dir or PLUMBLINE_SCENES) does not exist", folder.string()));
        }
        add_scene_files(folder, files);
        std::error_code ignored;
        for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
            if (entry.is_directory(ignored)) add_scene_files(entry.path(), files);
        }
    }
    std::ranges::sort(files, {}, &FoundScene::name);
    found.insert(found.end(), files.begin(), files.end());
    return found;
}

Scene SceneFinder::load(const std::string& name_or_path) const {
    // A word without dots and slashes is a name; a misspelt one deserves a better answer than "no such file".
    std::vector<std::string> names = builtin_scene_names();
    for (const std::string& name : wrapper_scene_names()) names.push_back(name);
    const bool is_name = name_or_path.find_first_of("./") == std::string::npos;
    if (is_name && std::ranges::find(names, name_or_path) == names.end()) {
        throw SceneError(fmt::format("no scene is called '{}'; {}", name_or_path, name_hint(name_or_path, names)));
    }
    return load_scene(name_or_path, scenes_dirs_);
}

const Camera& choose_camera(const Scene& scene, const std::string& name) {
    if (!name.empty()) return scene.camera(name);
    if (scene.cameras.empty())
        throw SceneError(fmt::format("scene '{}' has no view; add one to its scene file", scene.name));
    return scene.cameras.front();
}

}  // namespace plumb

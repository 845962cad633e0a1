// Scenes by name: the built-in ones, the scene files of the scenes folder, or any file's path.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace plumb {

struct FoundScene {
    std::string name;
    std::filesystem::path file;  // empty: built in
};

class SceneFinder {
public:
    // `scenes_dir` may be empty.
    explicit SceneFinder(std::filesystem::path scenes_dir);

    // Built-in scenes first, then the scene files (*.toml) in the scenes folder and in its folders, by name.
    std::vector<FoundScene> list() const;
    // Throws SceneError that lists the names there are.
    Scene load(const std::string& name_or_path) const;

private:
    std::filesystem::path scenes_dir_;
};

// The view that `name` asks for; the first one where it is empty. Throws SceneError.
const Camera& choose_camera(const Scene& scene, const std::string& name);

}  // namespace plumb

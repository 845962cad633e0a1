// Scenes by name: what there is to list, and how a name or path becomes a scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace plumb {

struct FoundScene {
    std::string name;  // what load() takes
    std::string from;  // "built in", "wrapper" (the description is part of the program, its mesh is not), or "file"
};

class SceneFinder {
public:
    explicit SceneFinder(std::vector<std::filesystem::path> scenes_dirs);

    // Built-in scenes, wrappers, and the scene files (*.toml) in the scene folders and in their folders. Throws
    // SceneError for a folder that does not exist.
    std::vector<FoundScene> list() const;
    // Throws SceneError.
    Scene load(const std::string& name_or_path) const;

private:
    std::vector<std::filesystem::path> scenes_dirs_;
};

// The view that `name` asks for; the first one where it is empty. Throws SceneError.
const Camera& choose_camera(const Scene& scene, const std::string& name);

}  // namespace plumb

#include "scenes/scene_error.h"

#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumb {
namespace {

constexpr const char* remedy = "Name the folder that holds it with --scenes-dir or PLUMBLINE_SCENES";

std::string with_folders(const std::string& scene, const std::string& file, const std::vector<std::string>& looked_in) {
    return fmt::format("scene '{}': '{}' not found (looked in '{}'). {}", scene, file, fmt::join(looked_in, "', '"),
                       remedy);
}

// A relative path is part of the scene's own name; an absolute one is the machine's.
std::string own_name(const std::filesystem::path& path) {
    return path.is_absolute() ? path.filename().string() : path.string();
}

}  // namespace

MissingSceneFile::MissingSceneFile(const std::string& scene, const std::string& file,
                                   const std::vector<std::string>& looked_in)
    : SceneError(with_folders(scene, file, looked_in)),
      without_folders_(fmt::format("scene '{}': '{}' not found. {}", std::filesystem::path(scene).filename().string(),
                                   own_name(file), remedy)) {}

}  // namespace plumb

#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace plumb {

// A scene, view or path that cannot be used; the message names the file, the element and the remedy.
class SceneError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// A file that a scene needs is not there. The message tells the folders that were looked in, which says something on
// this machine only.
class MissingSceneFile : public SceneError {
public:
    MissingSceneFile(const std::string& scene, const std::string& file, const std::vector<std::string>& looked_in);

    // The same without the name of any folder, for what is read elsewhere.
    const std::string& without_folders() const { return without_folders_; }

private:
    std::string without_folders_;
};

}  // namespace plumb

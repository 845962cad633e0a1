// Scenes that several steps of a run look at, each loaded once: what is there, what methods have an effect on, how much
// disk it takes, then the run itself. Loading a mesh of hundreds of thousands of triangles takes seconds.
#pragma once

#include <map>
#include <string>

#include "experiments/scene_finder.h"

namespace plumb {

class LoadedScenes {
public:
    // Keeps a reference to it.
    explicit LoadedScenes(const SceneFinder& finder) : finder_(finder) {}

    // Stays where it is until it is released. Throws SceneError as the finder does, at every call anew.
    const Scene& load(const std::string& name_or_path);
    // Nobody looks at it any more: its memory is free, and the next load() reads it again.
    void release(const std::string& name_or_path) { scenes_.erase(name_or_path); }

    const SceneFinder& finder() const { return finder_; }

private:
    const SceneFinder& finder_;
    std::map<std::string, Scene> scenes_;
};

}  // namespace plumb

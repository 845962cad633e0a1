// Whether what a reproduction measured before still stands, so that a run of many that was killed goes on with those
// that were not finished.
#pragma once

#include <map>
#include <string>

#include "experiments/reproduction.h"

namespace plumb {

// The scenes' contents, each worked out once.
class SceneHashes {
public:
    // Of a scene that cannot be loaded: that it is not there.
    const std::string& of(const std::string& scene, LoadedScenes& scenes);

private:
    std::map<std::string, std::string> hashes_;
};

// Tells all apart that decides what run_reproduction() measures: the experiment's file, the methods that it takes from
// others, the scenes as they are here, the OpenGL context asked for, and this very program.
std::string measuring_key(const Reproduction& reproduction, SceneHashes& hashes, LoadedScenes& scenes,
                          GlBackend backend, bool quick);

}  // namespace plumb

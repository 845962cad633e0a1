#include "experiments/loaded_scenes.h"

namespace plumb {

const Scene& LoadedScenes::load(const std::string& name_or_path) {
    const auto found = scenes_.find(name_or_path);
    return found != scenes_.end() ? found->second
                                  : scenes_.emplace(name_or_path, finder_.load(name_or_path)).first->second;
}

}  // namespace plumb

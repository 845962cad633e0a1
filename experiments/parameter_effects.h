// Which parameters of a method change something, and why the others do not.
//
// "Something" is a plane that may be asked for, in some scene: what only one scene lacks (an environment to fall back
// on) is told when a pipeline is made for it. Parameters that change the time alone (direct.shadow.cube_generation,
// gbuffer.depth_mapping...) do have an effect.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rasterizer/method.h"

namespace plumb {

// Why parameter `name` changes nothing in `method`; empty where it matters. `planes`: all that is asked for; null: it
// is not known, so that any plane may be.
std::string reason_without_effect(const Method& method, std::string_view name,
                                  const std::vector<std::string>* planes = nullptr);

}  // namespace plumb

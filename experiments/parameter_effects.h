// Which parameters of a method change something, and why the others do not.
//
// "Something" is a plane that is asked for or, where nobody knows what will be, any; in the scene that it is rendered
// of or, where that is not known, in some. Two things are asked: whether the method's other parameters leave it an
// effect, here, and whether a pass reads it that runs for these planes of that scene, of the passes
// (parameter_reach.h). Parameters that change the time alone (direct.shadow.cube_generation, gbuffer.depth_mapping...)
// do have an effect.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rasterizer/method.h"

namespace plumb {

struct Scene;

// Why parameter `name` changes nothing in `method`; empty where it matters. `planes`: all that is asked for; null: it
// is not known, so that any plane may be. `scene`: what is rendered; null: any scene may be.
std::string reason_without_effect(const Method& method, std::string_view name,
                                  const std::vector<std::string>* planes = nullptr, const Scene* scene = nullptr);
// The same of a method that is not made for these planes alone, such as a file that other experiments use as well: what
// belongs to stages that these planes do not show may stand in it.
std::string reason_without_effect_of_shared(const Method& method, std::string_view name,
                                            const std::vector<std::string>& planes);

}  // namespace plumb

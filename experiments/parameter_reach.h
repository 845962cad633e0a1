// Which of a method's parameters are read at all where certain planes of a scene are rendered: those that a pass that
// runs declares (PassDeclaration::parameters). No list of its own says what belongs to which plane.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rasterizer/method.h"
#include "scenes/scene.h"

namespace plumb {

// Why nothing that is rendered reads parameter `name`; empty where something does, and where a pipeline would not take
// the method or has none of the planes to give, which it says itself. `planes`: null: any may be asked for. A stage
// that is off counts as if it were on where `name` is what turns it on, since that is what leaving `name` out might do.
std::string reason_nobody_reads(const Method& method, std::string_view name, const std::vector<std::string>* planes,
                                const Scene& scene);

// All that a method has parameters for: lamps of each kind, an emissive surface, a specular lobe, an environment with
// an image, something that moves.
Scene make_scene_of_everything();

}  // namespace plumb

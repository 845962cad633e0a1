// All passes that there are, in the order of execution.
#pragma once

#include <vector>

#include "rasterizer/pass.h"

namespace plumb {

// Throws MethodError for parameters out of range or that cannot be combined.
void validate(const Method& method);

std::vector<PassDeclaration> declare_passes(const Scene& scene, const Method& method, const Quantities& quantities);

}  // namespace plumb

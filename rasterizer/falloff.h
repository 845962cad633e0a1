// The defines of falloff.glsl.
#pragma once

#include "frames/quantities.h"
#include "rasterizer/shader.h"

namespace plumb {

// FALLOFF, and the names of its values.
ShaderDefines falloff_defines(Falloff falloff);

}  // namespace plumb

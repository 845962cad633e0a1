// How many fragments the point and spot lights shade in one frame: what light volumes save.
//
// Without volumes every light is evaluated at every pixel, so that the count is their product. With volumes those
// fragments count that run the lighting shader (LightVolumePass::fragments_shaded), of the first layer alone.
#pragma once

#include <cstdint>

#include "rasterizer/method.h"
#include "scenes/camera.h"
#include "scenes/scene.h"

namespace plumb {

class GlContext;

// Renders the view with counters, which take time, and no more passes than direct light needs. Throws MethodError for a
// method that cannot make direct light.
std::uint64_t count_light_fragments(GlContext& context, const Scene& scene, const Method& method, const View& view);

}  // namespace plumb

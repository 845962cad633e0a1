// How right the normals of faces are that a shader makes from a depth plane alone, as ambient obscurance does with
// `normals = face` (rasterizer/ambient_obscurance.h has the formula, which stands here once more).
#pragma once

#include "frames/frame.h"
#include "scenes/camera.h"

namespace plumb {

// The mean angle, in degrees, between those normals and the true ones, over pixels where the surface is flat: the pixel
// and its four neighbours show the same instance and the same normal, to a millionth. There the normal of the face is
// the surface's own, and no edge is near. `depth` is as the method has it; `exact` holds depth, normal and instance as
// rays find them (PathTracer::gbuffer). NaN where nothing is flat.
double depth_normal_degrees(const Image& depth, const Frame& exact, const View& view);

}  // namespace plumb

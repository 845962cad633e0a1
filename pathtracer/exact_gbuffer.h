// The G-buffer as rays find it: exact, layer by layer, through pixel centres.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "frames/frame.h"
#include "pathtracer/reference.h"
#include "pathtracer/traced_scene.h"

namespace plumb {

// Where pixels stand that lie row by row.
inline std::size_t pixel_index(const View& view, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width()) + static_cast<std::size_t>(x);
}

// The nearest hit of each pixel's ray between the camera's planes, row by row.
std::vector<SurfaceHit> first_layer(const TracedScene& scene, const View& view);
// For each pixel the nearest hit that is deeper than `layer`'s by more than `minimum_separation`, along the view axis.
std::vector<SurfaceHit> next_layer(const TracedScene& scene, const View& view, const std::vector<SurfaceHit>& layer,
                                   float minimum_separation);

// Metres along the camera's -Z per metre along a pixel's unit direction.
float depth_per_distance(const View& view, const glm::vec3& direction);

// True for depth, normal, albedo, position, motion, instance, seen_before, also after "layer2." and so on.
bool is_gbuffer_plane(std::string_view plane);
// 1 for the planes without prefix, N for "layerN."; 0 where the prefix is malformed.
int layer_of(std::string_view plane);

// Adds one plane of a layer to `frame` under its full name.
void write_gbuffer_plane(const TracedScene& scene, const View& view, const View* previous_view,
                         const std::vector<SurfaceHit>& hits, const std::string& plane, Frame& frame);

}  // namespace plumb

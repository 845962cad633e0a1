#include "rasterizer/reprojection.h"

#include <algorithm>

namespace plumb {
namespace {

constexpr const char* displacement_plane = "displacement";

bool anything_moves(const Scene& scene) { return std::ranges::any_of(scene.instances, &Instance::moves); }

}  // namespace

Reprojection::Reprojection(const PassResources& resources, GLuint unit) : unit_(unit) {
    if (anything_moves(resources.scene)) displacement_ = &resources.planes.get(displacement_plane);
}

ShaderDefines Reprojection::defines() const {
    if (!displacement_) return {};
    return {{"DISPLACEMENT_UNIT", std::to_string(unit_)}};
}

void Reprojection::bind() const {
    if (displacement_) displacement_->bind(unit_);
}

std::vector<std::string> Reprojection::inputs(const Scene& scene, int layer) {
    if (!anything_moves(scene)) return {};
    return {layer_prefix(layer) + displacement_plane};
}

}  // namespace plumb

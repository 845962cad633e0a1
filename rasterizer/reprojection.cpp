#include "rasterizer/reprojection.h"

#include "rasterizer/instance_motion.h"

namespace plumb {

Reprojection::Reprojection(const PassResources& resources, GLuint unit) : unit_(unit) {
    if (anything_moves(resources.scene)) moving_instance_ = &resources.planes.get(moving_instance_plane);
}

ShaderDefines Reprojection::defines() const {
    if (!moving_instance_) return {};
    return {{"MOVING_INSTANCE_UNIT", std::to_string(unit_)}};
}

void Reprojection::bind() const {
    if (moving_instance_) moving_instance_->bind(unit_);
}

std::vector<std::string> Reprojection::inputs(const Scene& scene, int layer) {
    if (!anything_moves(scene)) return {};
    return {layer_prefix(layer) + moving_instance_plane};
}

}  // namespace plumb

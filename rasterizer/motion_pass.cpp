#include "rasterizer/motion_pass.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace plumb {
namespace {

bool anything_moves(const Scene& scene) { return std::ranges::any_of(scene.instances, &Instance::moves); }

ShaderDefines defines_for(const Scene& scene) {
    if (!anything_moves(scene)) return {};
    return {{"DISPLACEMENT", "1"}};
}

}  // namespace

MotionPass::MotionPass(const PassResources& resources, int layer)
    : depth_(resources.planes.get("depth")),
      layer_(layer),
      draw_(resources.context, resources.programs, "motion.frag", defines_for(resources.scene)) {
    if (anything_moves(resources.scene)) displacement_ = &resources.planes.get("displacement");
    // Whichever layer's pass is made first allocates for both.
    if (!resources.planes.has("motion")) resources.planes.create("motion", GL_RG32F, resources.layers_of("motion"));
    target_ = GlFramebuffer(resources.context, std::array{GlAttachment{&resources.planes.get("motion"), layer}}, {},
                            "motion");
}

void MotionPass::execute(const PassFrame&) {
    depth_.bind(0);
    if (displacement_) displacement_->bind(1);
    draw_.program().set("layer", layer_);
    draw_.draw(target_);
}

PassDeclaration declare_motion(const Scene& scene, int layer) {
    const std::string prefix = layer_prefix(layer);
    PassDeclaration pass;
    pass.name = layer == 0 ? "motion" : fmt::format("motion.layer{}", layer + 1);
    pass.inputs = {prefix + "depth"};
    if (anything_moves(scene)) pass.inputs.push_back(prefix + "displacement");
    pass.outputs = {prefix + "motion"};
    pass.create = [layer](const PassResources& resources) { return std::make_unique<MotionPass>(resources, layer); };
    return pass;
}

}  // namespace plumb

#include "rasterizer/motion_pass.h"

#include <array>

#include <fmt/format.h>

namespace plumb {
namespace {

constexpr GLuint motion_instance_unit = 1;

}  // namespace

MotionPass::MotionPass(const PassResources& resources, int layer)
    : depth_(resources.planes.get("depth")),
      reprojection_(resources, motion_instance_unit),
      layer_(layer),
      draw_(resources.context, resources.programs, "motion.frag", reprojection_.defines()) {
    // Whichever layer's pass is made first allocates for both.
    if (!resources.planes.has("motion")) resources.planes.create("motion", GL_RG32F, resources.layers_of("motion"));
    target_ = GlFramebuffer(resources.context, std::array{GlAttachment{&resources.planes.get("motion"), layer}}, {},
                            "motion");
}

void MotionPass::execute(const PassFrame&) {
    depth_.bind(0);
    reprojection_.bind();
    draw_.program().set("layer", layer_);
    draw_.draw(target_);
}

PassDeclaration declare_motion(const Scene& scene, int layer) {
    const std::string prefix = layer_prefix(layer);
    PassDeclaration pass;
    pass.name = layer == 0 ? "motion" : fmt::format("motion.layer{}", layer + 1);
    pass.inputs = {prefix + "depth"};
    for (std::string& plane : Reprojection::inputs(scene, layer)) pass.inputs.push_back(std::move(plane));
    pass.outputs = {prefix + "motion"};
    pass.create = [layer](const PassResources& resources) { return std::make_unique<MotionPass>(resources, layer); };
    return pass;
}

}  // namespace plumb

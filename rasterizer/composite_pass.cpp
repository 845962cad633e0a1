#include "rasterizer/composite_pass.h"

#include <array>

#include "rasterizer/temporal_antialias.h"

namespace plumb {
namespace {

bool has_emission(const Scene& scene) { return scene.has_emissive_surfaces() || !scene.environment.is_black(); }

ShaderDefines defines(const Scene& scene, const Method& method) {
    ShaderDefines result;
    if (has_emission(scene)) result.emplace_back("EMISSION", "1");
    if (method.radiosity.enabled) result.emplace_back("INDIRECT", "1");
    return result;
}

}  // namespace

CompositePass::CompositePass(const PassResources& resources)
    : direct_(resources.planes.get("direct")),
      draw_(resources.context, resources.programs, "composite.frag", defines(resources.scene, resources.method)) {
    if (has_emission(resources.scene)) emission_ = &resources.planes.get("emission");
    if (resources.method.radiosity.enabled) indirect_ = &resources.planes.get("indirect");
    const GlTexture& total = resources.planes.create(composited_plane(resources.method), GL_RGBA16F, 1);
    target_ = GlFramebuffer(resources.context, std::array{GlAttachment{&total}}, {}, "composite");
}

void CompositePass::execute(const PassFrame&) {
    direct_.bind(0);
    if (emission_) emission_->bind(1);
    if (indirect_) indirect_->bind(2);
    draw_.draw(target_);
}

PassDeclaration declare_composite(const Scene& scene, const Method& method) {
    PassDeclaration pass;
    pass.name = "composite";
    pass.inputs = {"direct"};
    pass.remark = "direct";
    if (has_emission(scene)) {
        pass.inputs.emplace_back("emission");
        pass.remark += " + emission";
    }
    if (method.radiosity.enabled) {
        pass.inputs.emplace_back("indirect");
        pass.remark += " + indirect";
    }
    pass.outputs = {composited_plane(method)};
    pass.create = [](const PassResources& resources) { return std::make_unique<CompositePass>(resources); };
    return pass;
}

}  // namespace plumb

#include "rasterizer/lamp_highlights_pass.h"

#include <array>

#include "rasterizer/shadow_pass.h"

namespace plumb {
namespace {

// Texture units of lamp_highlights.frag besides those of LightBuffers.
struct LampHighlightUnits {
    enum : GLuint { depth, normal, specular, roughness = 8 };
};

}  // namespace

LampHighlightsPass::LampHighlightsPass(const PassResources& resources)
    : context_(resources.context),
      lights_(resources, LightKinds::lamps),
      draw_(context_, resources.programs, "lamp_highlights.frag", defines()),
      depth_(resources.planes.get("depth")),
      normal_(resources.planes.get("normal")),
      specular_(resources.planes.get("specular")),
      roughness_(resources.planes.get("roughness")),
      area_(resources, {0, 0}) {
    const GlTexture& highlights = resources.planes.create(lamp_highlights_plane, GL_RGBA32F, 1);
    target_ = GlFramebuffer(context_, std::array{GlAttachment{&highlights}}, {}, "lamp highlights");
    draw_.program().set("layer", 0);
}

ShaderDefines LampHighlightsPass::defines() const {
    ShaderDefines result = light_count_defines(lights_.lights());
    for (auto& define : lights_.shadow_defines()) result.push_back(std::move(define));
    return result;
}

void LampHighlightsPass::execute(const PassFrame&) {
    depth_.bind(LampHighlightUnits::depth);
    normal_.bind(LampHighlightUnits::normal);
    specular_.bind(LampHighlightUnits::specular);
    roughness_.bind(LampHighlightUnits::roughness);
    lights_.bind();
    const InnerArea::Restriction restriction(area_);
    draw_.draw(target_);
}

PassDeclaration declare_lamp_highlights(const LightSet& lights, const Method& method) {
    PassDeclaration pass;
    pass.name = "lamp highlights";
    pass.inputs = {"depth", "normal", "specular", "roughness"};
    for (std::string& texture : shadow_textures(lights, LightKinds::lamps)) pass.inputs.push_back(std::move(texture));
    pass.outputs = {lamp_highlights_plane};
    if (!(lights.points.empty() && lights.spots.empty())) pass.parameters = {{"direct.shadow.lamps"}};
    pass.create = [](const PassResources& resources) { return std::make_unique<LampHighlightsPass>(resources); };
    pass.remark = lights.summary();
    if (!method.reflections.enabled) pass.disabled = "method.reflections.enabled is false";
    if (!method.reflections.lamps) pass.disabled = "reflections.lamps is false";
    return pass;
}

}  // namespace plumb

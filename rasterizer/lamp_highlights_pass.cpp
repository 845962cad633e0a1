#include "rasterizer/lamp_highlights_pass.h"

#include <array>

#include <fmt/format.h>

#include "rasterizer/shadow_pass.h"

namespace plumb {
namespace {

// Texture units of lamp_highlights.frag.
struct LampHighlightUnits {
    enum : GLuint { depth, normal, specular, points, maps, paraboloids = 7, roughness };
};

}  // namespace

LampHighlightsPass::LampHighlightsPass(const PassResources& resources)
    : context_(resources.context),
      lights_(resources.scene, resources.method.direct),
      draw_(context_, resources.programs, "lamp_highlights.frag", defines(resources)),
      points_(GlBuffer::from(context_, lights_.points)),
      spots_(GlBuffer::from(context_, lights_.spots)),
      directionals_(GlBuffer::from(context_, lights_.directionals)),
      depth_(resources.planes.get("depth")),
      normal_(resources.planes.get("normal")),
      specular_(resources.planes.get("specular")),
      roughness_(resources.planes.get("roughness")),
      shadow_points_(resources.planes.find("shadow.points")),
      shadow_paraboloids_(resources.planes.find("shadow.paraboloids")),
      shadow_maps_(resources.planes.find("shadow.maps")),
      area_(resources, {0, 0}) {
    const GlTexture& highlights = resources.planes.create(lamp_highlights_plane, GL_RGBA32F, 1);
    target_ = GlFramebuffer(context_, std::array{GlAttachment{&highlights}}, {}, "lamp highlights");
    draw_.program().set("layer", 0);
}

ShaderDefines LampHighlightsPass::defines(const PassResources& resources) const {
    ShaderDefines result;
    const auto add_count = [&](const char* name, std::size_t count) {
        if (count > 0) result.emplace_back(name, fmt::format("{}", count));
    };
    add_count("POINT_LIGHTS", lights_.points.size());
    add_count("SPOT_LIGHTS", lights_.spots.size());
    add_count("DIRECTIONAL_LIGHTS", lights_.directionals.size());
    for (auto& define : shadow_defines(lights_, resources.method.direct.shadow)) result.push_back(std::move(define));
    return result;
}

void LampHighlightsPass::execute(const PassFrame&) {
    depth_.bind(LampHighlightUnits::depth);
    normal_.bind(LampHighlightUnits::normal);
    specular_.bind(LampHighlightUnits::specular);
    roughness_.bind(LampHighlightUnits::roughness);
    if (shadow_points_) shadow_points_->bind(LampHighlightUnits::points);
    if (shadow_paraboloids_) shadow_paraboloids_->bind(LampHighlightUnits::paraboloids);
    if (shadow_maps_) shadow_maps_->bind(LampHighlightUnits::maps);
    const std::array<const GlBuffer*, 3> buffers{&points_, &spots_, &directionals_};
    for (std::size_t i = 0; i < buffers.size(); ++i) buffers[i]->bind(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(i));
    const InnerArea::Restriction restriction(area_);
    draw_.draw(target_);
}

PassDeclaration declare_lamp_highlights(const LightSet& lights, const Method& method) {
    PassDeclaration pass;
    pass.name = "lamp highlights";
    pass.inputs = {"depth", "normal", "specular", "roughness"};
    for (std::string& texture : shadow_textures(lights)) {
        if (texture != "shadow.emitters") pass.inputs.push_back(std::move(texture));
    }
    pass.outputs = {lamp_highlights_plane};
    pass.create = [](const PassResources& resources) { return std::make_unique<LampHighlightsPass>(resources); };
    pass.remark = lights.summary();
    if (!method.reflections.enabled) pass.disabled = "method.reflections.enabled is false";
    if (!method.reflections.lamps) pass.disabled = "reflections.lamps is false";
    return pass;
}

}  // namespace plumb

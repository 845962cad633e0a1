// What the specular lobe of the first layer reflects of point, spot and directional lights: the plane
// `reflection.lamps`, RGBA32F, which the plane `reflection` contains.
//
//     sum over lights of f(wo, wi) cos(wi) E_perpendicular V     f: scenes/ggx.h; V: their shadow maps
//
// The path tracer counts these highlights in `reflection`, never in `direct`, and so does this. A mirror shows nothing
// of lights without extent. Every light at every pixel, without light volumes: the lobe's tail has no end that a
// threshold of irradiance could cut.
//   Not simulated: the angular radius of directional lights, whose highlights on smooth surfaces are smaller and
//   brighter than those of a disc. RGBA32F, as the highlight of a nearly smooth surface exceeds half floats.
#pragma once

#include "rasterizer/fullscreen.h"
#include "rasterizer/inner_area.h"
#include "rasterizer/light_buffers.h"
#include "rasterizer/pass.h"

namespace plumb {

inline constexpr const char* lamp_highlights_plane = "reflection.lamps";

class LampHighlightsPass final : public Pass {
public:
    explicit LampHighlightsPass(const PassResources& resources);
    void execute(const PassFrame& frame) override;

private:
    ShaderDefines defines() const;

    GlContext& context_;
    LightBuffers lights_;
    FullscreenDraw draw_;
    const GlTexture &depth_, &normal_, &specular_, &roughness_;
    GlFramebuffer target_;
    InnerArea area_;
};

PassDeclaration declare_lamp_highlights(const LightSet& lights, const Method& method);

}  // namespace plumb

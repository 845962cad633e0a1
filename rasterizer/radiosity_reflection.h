// What the surfaces of one layer reflect of the light that a bounce of radiosity gathered: the plane `indirect.k`.
//
//     indirect.k = albedo / pi  boost(E_k) E_k
//     boost(E)   = unsaturated_boost + (saturated_boost - unsaturated_boost) S,  S = (max E - min E) / max E
//
// over the colour channels, S = 0 in the dark. A boost of 1 and 1 conserves energy; the demo of Mara et al. ships 2 and
// 1 for stronger colour bleeding.
//   Source of the boost: that demo, whose S is the saturation of the incoming light. The paper prints boost = S of the
//   surface's reflectance instead, by which grey surfaces would reflect nothing at all.
//
// The second layer reflects what RadiositySettings::second_layer says: the E_k of the first layer's point at the same
// pixel (reuse, as the demo: free, and wrong where the two lie in different light), or that of its own point (gather,
// as Nielsen 2015: costs as much as the first layer's). It is there for the next bounce to gather from; the format is
// then that of the other lit layers (gbuffer.radiance_format).
#pragma once

#include "rasterizer/fullscreen.h"
#include "rasterizer/inner_area.h"
#include "rasterizer/pass.h"

namespace plumb {

class RadiosityReflectionPass final : public Pass {
public:
    RadiosityReflectionPass(const PassResources& resources, int bounce, int layer);
    void execute(const PassFrame& frame) override;

private:
    const GlTexture& gathered_;
    const GlTexture& albedo_;
    GlFramebuffer target_;
    FullscreenDraw draw_;
    InnerArea area_;
};

PassDeclaration declare_radiosity_reflection(const Scene& scene, const Method& method, int bounce, int layer);

// For radiosity_boost.glsl.
ShaderDefines boost_defines(const RadiositySettings& settings);

}  // namespace plumb

// What radiosity gives in the end: those of the planes `irradiance`, `confidence` and `indirect` that are read.
//
//     irradiance = c sum_k E_k + (1 - c) E_fill                                            E_k: of bounce k
//     indirect   = albedo / pi (c sum_k boost(E_k) E_k + (1 - c) E_fill)                   (radiosity_reflection.h)
//     confidence = that of the first bounce; taps hit or miss by geometry, so it is that of every other as well
//
// c is the confidence and E_fill ambient light where the method fills (RadiositySettings::fill, ambient_light.h);
// else c is 1. The fill is not reflected again: bounces and what is carried on hold only what taps found, as in the
// source. It is light after bounces that nobody counted: the planes indirect.k are as gathered, without it and c.
//   Source: Mara et al. 2016, section on confidence, which interpolates between radiosity and a precomputed solution.
//   Good for: surfaces that see little of the view. Bad for: what ambient light counts a second time (ambient_light.h);
//   confidence tells that taps were found, not that they were the right ones, and half the taps around a pixel on a
//   flat wall never hit: c is small on many surfaces whose E is right.
#pragma once

#include "rasterizer/ambient_light.h"
#include "rasterizer/fullscreen.h"
#include "rasterizer/inner_area.h"
#include "rasterizer/pass.h"

namespace plumb {

class RadiositySumPass final : public Pass {
public:
    explicit RadiositySumPass(const PassResources& resources);
    void execute(const PassFrame& frame) override;

private:
    ShaderDefines defines(const PassResources& resources) const;

    std::vector<const GlTexture*> gathered_;  // of each bounce
    const GlTexture& albedo_;
    const GlTexture* depth_ = nullptr;  // where the method fills
    const GlTexture* normal_ = nullptr;
    AmbientLight fill_;
    ShaderDefines locations_;  // where each output that is read goes
    GlFramebuffer target_;
    FullscreenDraw draw_;
    InnerArea area_;
};

PassDeclaration declare_radiosity_sum(const Scene& scene, const Method& method);

}  // namespace plumb

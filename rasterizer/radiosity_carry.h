// One bounce of light a frame, carried on from frame to frame: the plane `radiosity.sent`, which the frame's one
// gathering reads.
//
//     sent = direct + (1 - damping) w albedo / pi boost(E_prev) E_prev                      (radiosity_reflection.h)
//     w    = 1 - smoothstep(carry_from, carry_to, |X_prev - Y_prev|)
//
// E_prev is what radiosity gave in the frame before, blurred, at the pixel where the point X of this frame was then
// (reprojection.h); X_prev is that point, Y_prev the one that the pixel showed. Of several layers that hold an E, the
// one is taken whose Y_prev is nearest. On the first frame and after cuts nothing is carried on; nor is it where a
// point was outside the image, guard band included.
//
// In n still frames E so becomes the sum of the first n bounces within a frame (radiosity.bounces), each times
// (1 - damping)^(k - 1), as long as what taps send adds up: with one layer, or with the estimator nielsen2015. With two
// layers mara2016 takes the layer that sends more in all, not in each bounce. `irradiance` and `indirect` then hold all
// bounces, and no indirect.k can be told apart. Good for: the cost of one bounce, in still views. Bad for: moving
// lights and objects, behind which each bounce lags by a frame; far and slanted surfaces under a moving camera, on
// which half a pixel is farther than carry_to.
//
// `damping` is that of the demo of Mara et al.: the fraction taken away (0.1 in its presets; 1: no second bounce at
// all). The paper's factor of the same purpose is what is left of the light, 1 - damping.
//   Source: Mara et al. 2016, "Deep G-Buffers for Stable Global Illumination Approximation"; the weight's distances:
//   the code that its authors ship with G3D.
//
// Choices where the sources are silent: E_prev is read from one pixel, the one that holds X_prev, not interpolated:
// four neighbours would each need their own test, and E is smooth by its blur. The second layer carries on what
// RadiositySettings::second_layer says: what the first layer's point at the same pixel does (reuse), an E of its own
// (gather: what was in either layer is found again in either), or nothing.
#pragma once

#include "rasterizer/fullscreen.h"
#include "rasterizer/pass.h"
#include "rasterizer/reprojection.h"

namespace plumb {

class RadiosityCarryPass final : public Pass {
public:
    // Throws MethodError for parameters out of range.
    explicit RadiosityCarryPass(const PassResources& resources);
    void execute(const PassFrame& frame) override;

private:
    ShaderDefines defines(const PassResources& resources) const;

    const PlaneTextures& planes_;
    const GlTexture& depth_;
    const GlTexture& previous_depth_;
    const GlTexture& direct_;
    const GlTexture& albedo_;
    bool takes_all_;  // damping 1: nothing is left
    Reprojection reprojection_;
    FullscreenDraw draw_;
    GlFramebuffer target_;  // all layers at once
};

PassDeclaration declare_radiosity_carry(const Scene& scene, const Method& method);

}  // namespace plumb

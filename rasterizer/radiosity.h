// Screen-space radiosity over one or two layers, one bounce.
//
// Gathers, per pixel, the irradiance E at X from the light that the visible layers reflect: N taps on a spiral in
// screen space (sample_spiral.h). With Y a tap's point, w the unit vector from X to Y, n_X and n_Y the normals and B
// the reflected diffuse radiance at Y (the plane `direct` of its layer), and g the falloff of the distance of X and Y
// within `radius` (Quantities::indirect_falloff; hard: 1):
//
//     E = 2 pi / M  sum B g max(0, w.n_X)      M: the taps that hit (or N, RadiosityNormalisation::samples)
//     confidence = M / N
//
// A tap hits where w.n_X > 0 and, if test_tap_normal is set, -w.n_Y > 0.01. A hit farther away than `radius` sends
// nothing; it still counts in M where the tap's normal is tested, and is no hit where it is not. With two layers a tap
// takes the one that sends more, and counts as a hit if either layer does.
//   Sources: Mara et al. 2016, "Deep G-Buffers for Stable Global Illumination Approximation"; the counting: the code
//   that its authors ship with G3D; Soler, Hoel, Rochet 2010, "A Deferred Shading Pipeline for Real-Time Indirect
//   Illumination". Good for: light from bright surfaces nearby. Bad for: light from outside the view, and light that
//   something blocks: no tap is tested for visibility. Taps are even in screen radius and angle, while 2 pi / M weighs
//   them as if they were even in solid angle, so that more taps do not converge to the integral; M averages over the
//   hits only, as if the rest of the hemisphere looked like them.
//
// Light that reaches X from emissive surfaces in one segment is `direct`, so they do not shine through taps. With
// `emitters_shine` they do, as in the sources: B is then direct + emission at Y. The emitters' light must be left out
// of `direct` (direct.emitters = false), or it would be counted twice, and takes the place of one bounce: `irradiance`,
// `indirect.1` and `indirect` hold light of emitters after no bounce besides light of lamps, suns and the environment
// after one. No plane then means what the truth's plane of its name means; what is to be compared is the sum direct +
// indirect, with the truth's direct + (of lamps, suns and environment only) indirect.1, which is the truth's `direct`
// where emissive surfaces are the only lights.
// Choices where the sources are silent: a tap outside the image (guard band included) or without a surface is no hit. A
// far tap reads the MIP chain of the depth only; normal and radiance are those of the very pixel that the chain's texel
// holds, at level 0: exact, at the price of scattered reads.
#pragma once

#include "rasterizer/bilateral_blur.h"
#include "rasterizer/fullscreen.h"
#include "rasterizer/pass.h"
#include "rasterizer/sample_spiral.h"

namespace plumb {

// Writes the plane `radiosity` (rgb: E; a: confidence), or `radiosity.unfiltered` where the method blurs it.
class RadiosityPass final : public Pass {
public:
    // Throws MethodError for parameters out of range.
    explicit RadiosityPass(const PassResources& resources);
    void execute(const PassFrame& frame) override;

private:
    const GlTexture& depth_;
    const GlTexture& normal_;
    const GlTexture* position_;  // where positions are stored
    const GlTexture& direct_;
    const GlTexture* emission_ = nullptr;
    SampleSpiral spiral_;
    FullscreenDraw draw_;
    GlFramebuffer target_;
    InnerArea area_;
};

// Writes those of the planes `irradiance` (E), `confidence`, `indirect.1` and `indirect` (albedo / pi E) that are read.
class RadiosityReflectionPass final : public Pass {
public:
    explicit RadiosityReflectionPass(const PassResources& resources);
    void execute(const PassFrame& frame) override;

private:
    const GlTexture& gathered_;
    const GlTexture& albedo_;
    ShaderDefines locations_;  // where each output that is read goes
    GlFramebuffer target_;
    FullscreenDraw draw_;
    InnerArea area_;
};

// The gathering, its blur and the reflection.
std::vector<PassDeclaration> declare_radiosity(const Method& method);

std::string_view to_string(RadiosityNormalisation normalisation);

}  // namespace plumb

// The sum that a camera sees: the plane `total`, RGBA16F; with reflections, whose highlights may exceed half floats, or
// lights that do, RGBA32F. Where it is anti-aliased over frames (temporal_antialias.h), this is the plane
// `total.aliased`.
//
//     physical   emission + direct + indirect + reflection       each term stands on its own: nothing multiplies it
//     demo       emission + (0.35 + 0.65 v) direct + c v indirect + (1 - 0.7 c) v albedo / pi E_ambient
//                + reflection
//                v = 0.95 ao + 0.05                      ambient visibility that never quite vanishes
//                c = clamp(2 (confidence - 0.35) + 0.35, 0, 1)      of the radiosity, which also boosts `indirect`
//
// Terms of stages that are not enabled are left out; without radiosity c is 0, and ambient light stands for all that
// bounces: what a static light probe alone would give. E_ambient is what CompositeSettings::fill says
// (ambient_light.h), or nothing. `demo` is no physical sum, in four places: visibility dims direct light; it dims
// indirect light, which came from what is near; confidence, which only counts taps, dims indirect light; and ambient
// light goes on where indirect light was found. Where the scene has an environment, `direct` holds its light times ao
// already, and a fill from it counts it twice: the demo keeps it in the ambient term alone.
//   Source of demo: the code that Mara et al. ship with G3D.
#pragma once

#include "rasterizer/ambient_light.h"
#include "rasterizer/fullscreen.h"
#include "rasterizer/pass.h"

namespace plumb {

class CompositePass final : public Pass {
public:
    explicit CompositePass(const PassResources& resources);
    void execute(const PassFrame& frame) override;

private:
    std::vector<const GlTexture*> planes_;  // by texture unit
    AmbientLight ambient_;
    FullscreenDraw draw_;
    GlFramebuffer target_;
};

// Throws MethodError where the demo's composite lacks what it reads.
PassDeclaration declare_composite(const Scene& scene, const Method& method);

}  // namespace plumb

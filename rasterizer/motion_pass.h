// Motion vectors of one layer: RG32F, per pixel the previous position minus the present one (motion.frag defines them),
// for moving cameras and moving instances.
#pragma once

#include "rasterizer/fullscreen.h"
#include "rasterizer/pass.h"
#include "rasterizer/reprojection.h"

namespace plumb {

class MotionPass final : public Pass {
public:
    MotionPass(const PassResources& resources, int layer);
    void execute(const PassFrame& frame) override;

private:
    const GlTexture& depth_;
    Reprojection reprojection_;
    int layer_;
    FullscreenDraw draw_;
    GlFramebuffer target_;
};

PassDeclaration declare_motion(const Scene& scene, int layer);

}  // namespace plumb

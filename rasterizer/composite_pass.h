// The sum that a camera sees: `total` = emission + direct + indirect, RGBA16F. Each term stands on its own; ambient
// visibility, confidence or boosts multiply nothing here.
#pragma once

#include "rasterizer/fullscreen.h"
#include "rasterizer/pass.h"

namespace plumb {

class CompositePass final : public Pass {
public:
    explicit CompositePass(const PassResources& resources);
    void execute(const PassFrame& frame) override;

private:
    const GlTexture& direct_;
    const GlTexture* emission_ = nullptr;
    const GlTexture* indirect_ = nullptr;
    FullscreenDraw draw_;
    GlFramebuffer target_;
};

PassDeclaration declare_composite(const Scene& scene, const Method& method);

}  // namespace plumb

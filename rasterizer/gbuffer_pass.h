// One layer of the deep G-buffer by a geometry pass of its own: depth peeling.
//
// The first layer is the nearest surface of each pixel. Each further one is peeled: the nearest surface that lies more
// than the minimum separation of linear depth behind the layer before it, so that near-coplanar detail does not use
// layers up. Exact whatever moves; a layer costs a pass over all geometry.
//   Source: depth peeling, Everitt 2001; minimum separation, Mara et al. 2016, "Deep G-Buffers for Stable Global
//   Illumination Approximation"; as a fraction of the frustum, Nielsen 2015.
//
// gbuffer_planes.h says what the planes hold. The hardware's depth buffer is shared by the layers. Where somebody reads
// the depth of the frame before, the first layer's pass lets it trade places with this frame's.
#pragma once

#include "rasterizer/gbuffer_draw.h"

namespace plumb {

class GBufferPass final : public Pass {
public:
    // `layer` counts from 0; a further layer needs the pass of the first one to be made before.
    GBufferPass(const PassResources& resources, int layer);
    void execute(const PassFrame& frame) override;

private:
    // The first layer's pass allocates for all.
    static const GlTexture& depth_buffer(const PassResources& resources, int layer);

    GlContext& context_;
    const GBufferSettings settings_;
    int layer_;
    DepthTest test_;
    const GlTexture& depth_buffer_;
    const GlTexture& depth_;
    const PlaneHistory* history_;  // null where nobody reads the depth of the frame before
    GBufferTargets targets_;
    GBufferDraw draw_;
    GlFramebuffer target_;
    std::optional<BackgroundDraw> background_;
};

// The pass of the first layer, or of both where the method generates them at once.
PassDeclaration declare_gbuffer(const Scene& scene, const Method& method);
// `layer` 1 to most_layers - 1.
PassDeclaration declare_peeled_layer(const Method& method, int layer);

}  // namespace plumb

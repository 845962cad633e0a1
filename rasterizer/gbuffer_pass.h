// One layer of the deep G-buffer, by rasterising the scene.
//
// The first layer is the nearest surface of each pixel. The second is peeled: the nearest surface that lies more than
// `minimum_separation` metres of linear depth behind the first, so that near-coplanar detail does not use it up.
//   Source: depth peeling, Everitt 2001; minimum separation, Mara et al. 2016, "Deep G-Buffers for Stable Global
//   Illumination Approximation".
//
// Planes (array textures, layer k of the G-buffer in layer k): `depth` R32F, metres along -Z, +infinity where nothing
// is; `normal` RG16, octahedral, world space, turned to the viewer; `albedo` RGBA16F; `emission` RGBA16F, in the first
// layer also the environment's radiance where nothing is in front of it; `displacement` RGBA32F, where the surface point
// of an instance that moves was in the frame before minus where it is, camera space of now, metres. Of these only the
// ones that somebody reads exist. The hardware depth buffer is shared by the layers: reversed (near = 1, far = 0) 32-bit float.
#pragma once

#include <optional>
#include <vector>

#include "rasterizer/environment_light.h"
#include "rasterizer/fullscreen.h"
#include "rasterizer/pass.h"
#include "rasterizer/scene_geometry.h"

namespace plumb {

class GBufferPass final : public Pass {
public:
    // `layer` 0 or 1; the second layer needs the first one's pass to be made before.
    GBufferPass(const PassResources& resources, int layer);
    void execute(const PassFrame& frame) override;

private:
    void create_planes(const PassResources& resources);
    void create_targets(const PassResources& resources);
    void draw_scene(const Frustum& frustum) const;
    void draw_background() const;

    GlContext& context_;
    const Scene& scene_;
    const SceneGeometry& geometry_;
    int layer_;
    const GlTexture* first_depth_ = nullptr;
    const GlTexture* depth_buffer_ = nullptr;
    GlFramebuffer target_;
    GLint target_planes_ = 0;
    std::vector<const Program*> programs_;      // one per variant of the geometry
    std::optional<FullscreenDraw> background_;  // where the environment is seen
    std::optional<EnvironmentLight> environment_;
    GlFramebuffer background_target_;
};

PassDeclaration declare_gbuffer(const Scene& scene, const Method& method);
PassDeclaration declare_second_layer(const Method& method);

}  // namespace plumb

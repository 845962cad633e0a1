// Deferred direct lighting of one layer: the plane `direct`, RGBA16F.
//
// Sums what point, spot and directional lights, emissive surfaces and the environment send to each pixel in one
// segment, times the diffuse albedo / pi (what the specular lobe reflects of lights is `reflection`, and what it leaves
// for the diffuse one is gbuffer_planes.h's). Unoccluded, analytic lights and emitters of up to 64 triangles are exact;
// shadows are those of the shadow maps (shadow_pass.h), filtered over 2 x 2 texels.
//   Point and spot lights fall off as their attenuation says; they are shaded here, or by their volumes
//   (light_volume_pass.h) whose sum this pass adds. Not simulated: the angular radius of directional lights, whose
//   shadows stay sharp (direct.shadow.pcf_radius blurs them by one width everywhere); transmission, since a transparent
//   surface casts the shadow of an opaque one. The environment's irradiance, of spherical harmonics
//   (environment_light.h) or of a cube (radiance_maps.h), is unoccluded and multiplied with the ambient visibility `ao`
//   of the first layer where the method has it: within the quantity's radius that is occlusion, beyond it the sky
//   shines through walls. The second layer takes the same pixel's ambient visibility, since no pass computes one of its
//   own. Bad for: interiors under an open sky; penumbras, unless direct.shadow.emitter_samples is raised.
#pragma once

#include "rasterizer/fullscreen.h"
#include "rasterizer/light_buffers.h"
#include "rasterizer/pass.h"

namespace plumb {

class DirectLightPass final : public Pass {
public:
    DirectLightPass(const PassResources& resources, int layer);
    void execute(const PassFrame& frame) override;

private:
    ShaderDefines defines(const PassResources& resources) const;
    void set_environment(const PassResources& resources) const;

    GlContext& context_;
    int layer_;
    LightBuffers lights_;
    bool dark_;  // nothing shines: the shader reads nothing
    FullscreenDraw draw_;
    const GlTexture &depth_, &normal_, &albedo_;
    const GlTexture* local_irradiance_ = nullptr;
    const GlTexture* environment_irradiance_ = nullptr;
    const GlTexture* ambient_visibility_ = nullptr;
    GlFramebuffer target_;
};

PassDeclaration declare_direct_light(const Scene& scene, const LightSet& lights, const Method& method, int layer);

}  // namespace plumb

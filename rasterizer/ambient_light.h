// Ambient light: irradiance that stands in for what a method cannot find, by the normal alone. Its sources:
//
//     ambient       E = pi L, L a constant radiance
//     environment   that of the scene's environment, nothing in its way: the cube `environment.irradiance`
//     probe         what arrives at the captured probe: the cube `probe.irradiance`
//
// What each counts a second time beside the other planes: the environment's light is in `direct` already, for what of
// it ambient visibility lets through; the probe sees the environment as well, and emissive surfaces, whose light is
// `direct` too. What the probe sees of lit surfaces is light after one bounce, which radiosity.h looks for. The
// constant is nobody's light.
//   Source: the fill of Mara et al. 2016, for light that no layer holds; the cubes: radiance_maps.h.
//
// Shaders include ambient_light.glsl.
#pragma once

#include "rasterizer/pass.h"

namespace plumb {

class AmbientLight {
public:
    // `radiance`: of the constant source, W / (m^2 sr). `unit`: a texture unit that the pass uses for nothing else.
    AmbientLight(const PassResources& resources, AmbientSource source, float radiance, GLuint unit);
    // For ambient_light.glsl; empty where there is no source.
    ShaderDefines defines() const;
    void bind() const;

    // The planes that a pass reads for it.
    static std::vector<std::string> inputs(AmbientSource source);

private:
    AmbientSource source_;
    float radiance_;
    GLuint unit_;
    const GlTexture* cube_ = nullptr;
};

std::string_view to_string(AmbientSource source);

}  // namespace plumb

// What the surfaces of each layer send out, at several resolutions: what a wide lobe sees of them.
//
// The plane `radiance_chain`, RGBA16F, or RGBA32F where what it is made of has 32 bits (emission_format,
// gbuffer.radiance_format), one layer per layer of the G-buffer. Level 0 holds the radiance of each pixel
// (surface_radiance.glsl) and 1 in alpha, 0 where nothing is; a texel of a further level is the plain mean of the four
// below it, an odd last row or column left out. Radiance divided by alpha is thus the mean over the surfaces among the
// pixels, as if what is between them were not there; texels that cover an edge hold both of its sides.
//   Good for: footprints on one surface. Bad for: small bright things before a dark background far behind them, whose
//   light spreads over both.
#pragma once

#include "rasterizer/fullscreen.h"
#include "rasterizer/pass.h"

namespace plumb {

inline constexpr const char* radiance_chain_plane = "radiance_chain";

// The level of a single texel across the smaller side.
int coarsest_radiance_level(int width, int height);

// Which planes make up the radiance of a surface that is hit. As the path tracer counts: what emissive surfaces send is
// seen after no bounce, light that lamps, suns and sky sent there after one, light from further surfaces after more.
struct SurfaceRadiance {
    SurfaceRadiance(const Scene& scene, const Method& method, const Quantities& quantities);
    bool direct, emission, indirect;

    std::vector<std::string> planes(int layers) const;
    ShaderDefines defines() const;
};

// The planes of a SurfaceRadiance, bound to the units of surface_radiance.glsl.
class SurfaceRadiancePlanes {
public:
    SurfaceRadiancePlanes(const PlaneTextures& planes, const SurfaceRadiance& radiance);
    void bind() const;

private:
    const GlTexture* direct_ = nullptr;
    const GlTexture* emission_ = nullptr;
    const GlTexture* indirect_ = nullptr;
};

class RadianceMipChainPass final : public Pass {
public:
    explicit RadianceMipChainPass(const PassResources& resources);
    void execute(const PassFrame& frame) override;

private:
    SurfaceRadiancePlanes sources_;
    const GlTexture& depth_;
    const GlTexture& chain_;
    FullscreenDraw first_level_, further_levels_;
    std::vector<std::vector<GlFramebuffer>> targets_;  // by layer and level
};

PassDeclaration declare_radiance_mip_chain(const Scene& scene, const Method& method, const Quantities& quantities);

}  // namespace plumb

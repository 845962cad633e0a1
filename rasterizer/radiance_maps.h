// The light that arrives at a point from all around, as textures that shaders read by direction: for what reflects it
// diffusely and for what reflects it glossily.
//
// With L(d) the radiance from the unit direction d (the cube `NAME.radiance`, RGBA32F with all its MIP levels):
//     `NAME.irradiance`   E(n) = integral of L(d) max(0, n.d) over d, a cube of 16^2 texels a face.
//                         Summed over the texels of the level of at most 32^2 a face, by their solid angles; the
//                         weights are scaled so that a constant L gives exactly pi L.
//     `NAME.prefiltered`  P(r, alpha) = integral of L(d) D(h) (r.d) / integral of D(h) (r.d),  h = normalize(r + d),
//                         D the GGX distribution of alpha = roughness^2 (scenes/ggx.h). Level l of prefiltered_levels
//                         holds roughness l / (prefiltered_levels - 1), at half the size of the one before; level 0 is
//                         L. Half vectors are drawn from D by a Hammersley sequence of `samples` points; each reads the
//                         MIP level whose texels are as large as its share of directions.
// A surface with normal n, seen from o, of reflectances f0 and f90 then reflects, besides albedo / pi E(n), about
//     P(reflect(-o, n), alpha) (f0 A + f90 B),     A, B: SpecularAlbedo::split (specular_albedo_texture.h)
//   Sources: Karis 2013, "Real Shading in Unreal Engine 4" (the split sum, with n = o = r in P: lobes do not stretch at
//   grazing incidence); Krivanek, Colbert 2008, "Real-time Shading with Filtered Importance Sampling" (MIP levels).
//   Good for: surroundings far away in relation to the object. Bad for: sharp reflections at small `size`; reflections
//   near the horizon; a tiny sun, of which a few thousand half vectors see little at high roughness.
//
// Shaders include radiance_maps.glsl.
#pragma once

#include <array>
#include <string>

#include "rasterizer/fullscreen.h"
#include "rasterizer/pass.h"

namespace plumb {

constexpr int prefiltered_levels = 6;
constexpr int smallest_radiance_cube = 1 << (prefiltered_levels - 1);

class RadianceMaps {
public:
    // Allocates the three textures as planes; `size` texels per side of a face of the radiance and of the prefiltered
    // level 0, a power of two of at least smallest_radiance_cube.
    RadianceMaps(const PassResources& resources, const std::string& name, int size, int samples);

    // Where face `face` of the radiance is to be drawn (cube_faces.h has their order and orientation).
    const GlFramebuffer& face(int face) const { return faces_[static_cast<std::size_t>(face)]; }
    // Makes the other two textures from the radiance, once all its faces are drawn.
    void filter() const;

    static std::vector<std::string> outputs(const std::string& name);

private:
    GlContext& context_;
    int samples_;
    FullscreenDraw irradiance_draw_, prefilter_draw_;
    const GlTexture& radiance_;
    const GlTexture& irradiance_;
    const GlTexture& prefiltered_;
    std::array<GlFramebuffer, 6> faces_, irradiance_faces_;
    std::array<std::array<GlFramebuffer, 6>, prefiltered_levels> prefiltered_faces_;  // level 0 is copied
};

}  // namespace plumb

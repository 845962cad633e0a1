// Screen-space reflections: the plane `reflection`, radiance through the specular lobe of the first layer.
//
// A ray from the surface point X in direction w is projected: on the screen it is a straight line, along which the
// reciprocal of depth is linear. It ends where it leaves the view's frustum or is `max_distance` long. It is looked at
// `first_step` pixels (of the axis that it covers more pixels of) from X and then every `step` pixels, `max_steps`
// times at most. Between two looks its depth covers an interval; it passes behind a layer where that interval meets [z,
// z + thickness], z the layer's depth in the pixel of the second look; or, with hit = mara2016, comes near it where the
// interval meets [z - thickness, z + thickness]; or, with hit = crossed, also passes through it where the ray was no
// deeper at the first look than the layer in that pixel, and is no less deep at the second look than the layer there.
// The stretch is then halved `refinement_steps` times by the same question. What is found, the point Y in a pixel of
// the layer, is hit if it rises more than `bias` above X's tangent plane (the surface does not reflect itself) and,
// with test_hit_normal, faces the ray: what is seen of a surface from the front says nothing about its back. Else the
// ray goes on. Where both layers are passed in one step the first wins.
//   Which hit: `behind` misses a surface so slanted that its depth changes by more than the thickness from a pixel to
//   the next, and leaves stripes in what a floor reflects of a ceiling seen at a flat angle. `crossed` takes what two
//   neighbouring pixels show for one surface, and finds it; where they show an object and what lies behind it, rays
//   that pass behind the object end on its silhouette.
//   Sources: Mara et al. 2016, "Deep G-Buffers for Stable Global Illumination Approximation": a ray hits where it comes
//   within the separation of either layer, before or behind it (which thickens silhouettes and lets rays end before
//   they reach what they would hit), else the environment answers; McGuire, Mara 2014, "Efficient GPU Screen-Space Ray
//   Tracing": lines on the screen, in pixels, intervals of depth.
//
// With o the direction to the viewer, f0, f90 and alpha those of the material (scenes/ggx.h), L(w) what is found along
// w, and A, B the split sum's tables (scenes/specular_albedo.h):
//     mirror   (f0 A + f90 B) L(reflect(o))               one ray for all of the lobe; exact for a mirror
//     mip      the same, but L read from the MIP chain of what surfaces send out (radiance_mip_chain.h), where a texel
//              is as wide as the lobe's footprint: half of the microfacets' normals lie within atan(alpha) of the
//              surface's: half of the light comes from a patch of half widths |XY| tan(2 atan alpha) in the plane of
//              incidence and o.n times as much across it. A disc of the same area has the radius r = |XY| tan(2 atan
//              alpha) sqrt(o.n), and holds as much as half of a square of side sqrt(2 pi) r; no wider than reaches down
//              to X's tangent plane, below which no ray goes. What else the footprint overlaps is not told apart.
//     samples  mean of F G2 / G1 L(w_i), w_i reflected about visible normals (Heitz 2018), drawn by the R2 sequence
//              (Roberts 2018) from a hash of the pixel on. Converges to the lobe's integral over what the layers hold.
//              A mirror takes one ray.
// L(w) of a hit is what the method knows of Y, as the path tracer counts bounces: emission; with Quantities::bounces of
// 1 or more `direct`; of 2 or more, and with radiosity, also `indirect` (of the first layer, without the guard band).
// Y's own specular lobe is missing: mirrors show mirrors black, but for what is diffuse in them. Within border_fade
// pixels of the image's border (guard band included) hits fade into the fallback, as they do where nothing is hit:
//     none         black
//     environment  the scene's environment, prefiltered by roughness (radiance_maps.h)
//     probe        a probe's view, also prefiltered; without parallax
// The highlights of lamps and suns come in as their own plane (lamp_highlights_pass.h).
// Quantities::reflection_radius and its falloff apply as they do to the truth: what is farther away does not count.
// With a finite radius a fallback would not count either: that is an error.
//   Good for: what the view shows, reflected at grazing angles. Bad for: what only a mirror shows: the backs of things,
//   what is outside the view or hidden behind more than the layers hold; thin things thinner than a step; the path
//   tracer's `reflection` also holds what passes straight through transparent sheets, which this does not.
#pragma once

#include "rasterizer/fullscreen.h"
#include "rasterizer/inner_area.h"
#include "rasterizer/light_set.h"
#include "rasterizer/pass.h"
#include "rasterizer/radiance_mip_chain.h"

namespace plumb {

// Writes `reflection`, RGBA32F: a highlight may exceed half floats.
class ReflectionPass final : public Pass {
public:
    // Throws MethodError for parameters out of range.
    explicit ReflectionPass(const PassResources& resources);
    void execute(const PassFrame& frame) override;

private:
    GlContext& context_;
    const GBufferSettings gbuffer_;
    float thickness_;
    int rays_, rays_per_draw_;  // of a lobe; 0: one for all of it
    const GlTexture &depth_, &normal_, &specular_, &roughness_;
    const GlTexture* position_;  // where positions are stored
    const GlTexture* chain_ = nullptr;
    const GlTexture* lamps_ = nullptr;
    const GlTexture* fallback_ = nullptr;
    bool finds_light_ = false;  // without, only the plane of highlights is left
    SurfaceRadiancePlanes sources_;
    const GlTexture& specular_albedo_;
    FullscreenDraw draw_;
    GlFramebuffer target_;
    InnerArea area_;
};

// Highlights, MIP chain and reflections. A scene without specular lobes has a black plane.
std::vector<PassDeclaration> declare_reflections(const Scene& scene, const LightSet& lights, const Method& method,
                                                 const Quantities& quantities);

std::string_view to_string(ReflectionRoughness roughness);
std::string_view to_string(ReflectionFallback fallback);

}  // namespace plumb

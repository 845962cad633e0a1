// One gathering of light by screen-space radiosity: the irradiance E that the visible layers send to each pixel.
//
// N taps on a spiral in screen space (sample_spiral.h), which spreads over `radius` as it projects at the pixel or over
// `spread_pixels`. With X the pixel's point, Y a tap's point, w the unit vector from X to Y, n_X and n_Y the normals, B
// the diffuse radiance that leaves Y (radiosity_planes.h says which), and g the falloff of the distance of X and Y
// within `radius` (Quantities::indirect_falloff; hard: 1):
//
//     E = 2 pi / M  sum B g max(0, w.n_X)      M: the taps that hit (or all of them, RadiosityNormalisation::samples)
//     confidence = M / taps
//
// A tap hits where w.n_X > 0 and, if test_tap_normal is set, -w.n_Y > 0.01. The estimators differ in how they count:
//
//     mara2016      N taps. With two layers a tap takes the layer that sends more, and is a hit if either layer's point
//                   is. A point farther away than `radius` sends nothing; it is still a hit where the tap's normal is
//                   tested, and none where it is not.
//     nielsen2015   Each layer's point is a tap of its own, layers N in all, and what they send is added. A point
//                   farther away than `radius`, the cut-off, is no hit. As in the thesis with test_tap_normal = false
//                   and spread_pixels = 300 (at 720 lines), where the cut-off may be infinite.
//
//   Sources: Mara et al. 2016, "Deep G-Buffers for Stable Global Illumination Approximation"; its counting: the code
//   that its authors ship with G3D; Nielsen 2015, bachelor's thesis, Technical University of Denmark; Soler, Hoel,
//   Rochet 2010, "A Deferred Shading Pipeline for Real-Time Indirect Illumination". Good for: light from bright
//   surfaces nearby. Bad for: light from outside the view, and light that something blocks: no tap is tested for
//   visibility. Taps are even in screen radius and angle, while 2 pi / M weighs them as if they were even in solid
//   angle, so that more taps do not converge to the integral; M averages over the hits only, as if the rest of the
//   hemisphere looked like them.
//
// A far tap reads the MIP chain of the depth; its normal and radiance are those of the very pixel that the chain's
// texel holds. They are read at level 0, scattered, or with mip_normals_and_radiance from chains that are subsampled
// like the depth's, as implementers have it: the same texels, so the same light bit for bit, for a pass more and
// memory, and reads that fit a cache.
//
// The point of such a tap is that of the same pixel; with mip_points = sao2012, as the code shipped with G3D has it, it
// lies as deep as that pixel's but at the tap's own position.
//
// Choices where the sources are silent: a tap outside the image (guard band included) or without a surface is no hit.
// Either estimator takes the taps of either pattern of sample_spiral.h; the thesis goes with pattern = nielsen2015.
#pragma once

#include "rasterizer/fullscreen.h"
#include "rasterizer/inner_area.h"
#include "rasterizer/pass.h"
#include "rasterizer/sample_spiral.h"

namespace plumb {

// Writes one layer of the plane that gathered_plane() names.
class RadiosityGatherPass final : public Pass {
public:
    // Throws MethodError for parameters out of range. `layer`: whose points receive.
    RadiosityGatherPass(const PassResources& resources, int bounce, int layer);
    void execute(const PassFrame& frame) override;

private:
    const GlTexture& depth_;
    const GlTexture& normal_;
    const GlTexture* position_;  // where positions are stored
    const GlTexture& sent_;
    const GlTexture* emission_ = nullptr;
    const GlTexture* normal_chain_ = nullptr;
    SampleSpiral spiral_;
    FullscreenDraw draw_;
    GlFramebuffer target_;
    InnerArea area_;
};

// What the gathering of a bounce reads besides planes that others make: their MIP chains, where the method wants them.
std::vector<PassDeclaration> declare_gathered_chains(const RadiositySettings& settings, int bounce);
PassDeclaration declare_radiosity_gather(const Scene& scene, const Method& method, int bounce, int layer);

std::string_view to_string(RadiosityEstimator estimator);
std::string_view to_string(RadiosityNormalisation normalisation);

}  // namespace plumb

// Scalable ambient obscurance over one or two depth layers.
//
// Estimates, per pixel, the ambient visibility `ao` (the share of the hemisphere that is open, weighted by the cosine
// and the falloff g of the asked quantity) from N taps on a spiral in screen space (sample_spiral.h). With X the shaded
// point, n its normal, Y a tap's point, v = Y - X, beta the bias, eps the epsilon and A the larger value over the
// layers:
//
//     mara2016     A = g(|v|) max(0, v.n - beta) / sqrt(v.v + eps)     the default: as the paper prints it
//                  visibility = max(0, 1 - intensity sqrt(pi / N sum A))
//     g3d_demo     A as above, times 1 + 0.35 (max(0, 1.5 n_z) - 1)     n_z: towards the viewer; it depends on the view
//                  visibility = max(0, 1 - sqrt(3 / N sum A))^intensity taps at least 0.75 pixels away; fades in as the
//                                                                       radius grows from 3 to 4 pixels
//     sao2012      A = g(|v|) max(0, v.n - beta) / (v.v + eps)          of dimension 1 / m: intensity is in metres
//                  visibility = (a^0.2 + 1.2 a^4) / 2.2 with a = max(0, 1 - intensity 5 / N sum A)
//     sao2012_undivided
//                  A = c g(|v|) max(0, v.n - beta)                      intensity is in 1 / m; c = 4 for the quadratic
//                  visibility as sao2012                                falloff, 2 for the hard one; no cubic one
//     alchemy2011  A = g(|v|) max(0, v.n - beta z) / (v.v + eps)        z: the depth of X, so that beta is metres per
//                  visibility = max(0, 1 - intensity 2 / N sum A)^K     metre; intensity is in metres
//     nielsen2015  A = g(|v|) max(0, v.n / |v| - beta z) / (v.v + eps)  beta: per metre; intensity in square metres; M:
//                  visibility = max(0, 1 - intensity 2 / M sum A)^K     taps with v.n > 0 and g > 0; each layer's tap
//                                                                       counts for itself; 1 where M = 0
//     linear       A as mara2016                                        what a Monte Carlo sum over uniformly
//                  visibility = max(0, 1 - intensity 2 / N sum A)       distributed directions would be
//
// Sources: mara2016: Mara et al. 2016, "Deep G-Buffers for Stable Global Illumination Approximation"; g3d_demo: the
// code that its authors ship with G3D; sao2012: McGuire, Mara, Luebke 2012, "Scalable Ambient Obscurance", whose code
// has four falloffs: A is sao2012 with Falloff::hard, B (recommended) with Falloff::cubic, C is sao2012_undivided with
// Falloff::quadratic, D with Falloff::hard (it leaves the scale of A, C and D to the intensity, and so do we);
// alchemy2011: McGuire et al. 2011, "The Alchemy Screen-Space Ambient Obscurance Algorithm", as Nielsen's thesis of
// 2015 prints it; nielsen2015: what the listings of that thesis do. Both cut hard at the radius (Falloff::hard); the
// falloff is always the quantity's.
//   Good for: contact shadows of what the layers hold. Bad for: occluders outside the view or behind both layers; taps
//   are even in screen radius and angle, not in solid angle, so that no estimator here converges to the integral.
//
// Choices where the sources are silent: a tap outside the image (guard band included) and a tap without a surface
// obscure nothing; background is fully visible, and so is a pixel whose radius covers less than a pixel. With the MIP
// chain a far tap is the exact point of the pixel that its texel holds (depth_mip_chain.h), or with mip_points =
// sao2012, as in the source, as deep as that pixel's but at the tap's own position, which lifts taps off slanted
// surfaces and darkens them.
//
// Normals of faces are cross products of the differences to the points of a pixel beside and a pixel above or below:
//
//     face      of each pair the pixel whose depth is nearer; where an axis has none, all is visible
//     g3d_demo  the other pixels of the 2 by 2 that a pixel belongs to, counted from the image's corner, as a shader's
//               finest derivatives have them. They reach across edges, where the product is long: beyond 6e-5 z^2 all
//               is visible, and so it is where one of the pixels shows nothing. The length is that of images of some
//               700 lines; a frontal surface has (2 tan(fov / 2) / lines)^2 z^2, so that coarser images lose slanted
//               surfaces, and then all. Where frontal ones are lost the pass throws; a probe's faces, which have few
//               lines, take the surfaces' own normals in their place.
#pragma once

#include "rasterizer/bilateral_blur.h"
#include "rasterizer/fullscreen.h"
#include "rasterizer/pass.h"
#include "rasterizer/sample_spiral.h"

namespace plumb {

// nielsen2015 divides by the taps above the tangent plane. On a flat surface all lie in it, and rounding would decide
// which count; those less than 0.06 degrees above it count for nothing, which float depths and encoded normals resolve.
constexpr float least_hit_sine = 0.001f;

// How long the product of differences, over the square of the depth, may be for a normal of g3d_demo.
constexpr float longest_g3d_normal = 6e-5f;

// Writes the plane `ao`, or `ao.unfiltered` where the method blurs it, or else what the temporal filter takes.
class AmbientObscurancePass final : public Pass {
public:
    // Throws MethodError for an infinite radius and other parameters out of range.
    explicit AmbientObscurancePass(const PassResources& resources);
    // Throws MethodError where the normals of g3d_demo are so in name only (see above).
    void execute(const PassFrame& frame) override;

private:
    ObscuranceNormals normals_;
    const GlTexture& depth_;
    const GlTexture* normal_;    // where the normals of faces do not serve
    const GlTexture* position_;  // where positions are stored
    SampleSpiral spiral_;
    FullscreenDraw draw_;
    GlFramebuffer target_;
    InnerArea area_;
};

// The pass and its blur. Output: the plane `ao`, or `ao.of_frame` where the method filters it over time.
std::vector<PassDeclaration> declare_ambient_obscurance(const Method& method, const Quantities& quantities);
// The temporal filter. Outputs: `ao`; `ao.history_weight`, the weight that the frame before had at each pixel.
PassDeclaration declare_ambient_obscurance_over_time(const Scene& scene, const Method& method);

std::string_view to_string(AmbientObscuranceEstimator estimator);

}  // namespace plumb

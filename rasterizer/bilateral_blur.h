// A separable blur that smooths the noise of few taps along surfaces and stops at edges.
//
// First along rows, then along columns, each pixel becomes the mean of its neighbours up to radius R, i steps away,
// with
//
//     weight    = exp(-i^2 / (2 sigma^2)) w_depth w_normal w_plane^2,  sigma = R / 2
//     w_depth   = max(0, 1 - depth_sharpness |z - z'| / r)            r: the radius of the blurred quantity
//     w_normal  = max(0, 1 - normal_sharpness (1 - n.n'))
//     w_plane   = max(0, 1 - 2 plane_sharpness max(|u.n|, |u.n'|))     u: unit vector between the two points
//                 1 where their squared distance is less than plane_exemption
//
// With weights = g3d the Gaussian gives way to what the filters that Mara et al. ship with G3D have in its place, for R
// of 1 to 6: t_0 at the centre and 0.3 + t_i elsewhere, of a Gaussian of sum 1 and sigma 3 (R up to 4) or 4 (5 and 6;
// their comments say 2 and 3), and 0.5 and 0.25 for R = 1. Where R is 2, 3 or 5 the table is that of a larger R, cut
// off. (They also add 1e-4 to the sum of weights, which darkens by less than a thousandth.)
//
// With depth_key_bits of 8 or 16, z and z' in w_depth are what a stored key of so many bits holds of them, the fraction
// of the far plane (depth_key_pass.h; 8 bits show bands, as implementers report).
//
// The kinds gaussian_2015 (as the thesis' text prints it) and gaussian_2015_listing (as its program has it) know depth
// alone, and other widths:
//
//     weight    = exp(-i^2 / (2 sigma^2)) w_depth,   sigma = R / 3
//     w_depth   = max(0, 1 - |Z - Z'|)               gaussian_2015
//                 max(0, 1 - sqrt |Z - Z'|)          gaussian_2015_listing
//
// Z is the value of a depth buffer of the standard mapping, 0 at the near plane and 1 at the far one, whatever
// gbuffer.depth_mapping is: Z = far (z - near) / (z (far - near)). Beyond some metres all Z are nearly 1, so that
// gaussian_2015 stops at few edges; the root makes more of small differences.
//
// Where `monotonic` is set, there is no edge weight (w_depth w_normal w_plane^2) larger than that of the pixels
// between. Pixels outside the image and background have weight 0; background is left as it is. A constant image stays
// the same bit for bit.
//   Source: the filters that Mara et al. ship with G3D, their constants turned into metres. They exempt pixels close in
//   space from the plane weight (0.001 square metres for ambient obscurance, 0.01 for radiosity), which blurs across
//   contacts; here none is unless asked for. The other kinds: Nielsen 2015 (section 2.5 and listings 3.34 to 3.37),
//   whose program turns background black, which nothing reads.
//   Good for: noise of 10 to 60 taps. Bad for: thin objects, whose few pixels have few neighbours.
#pragma once

#include <string>

#include "rasterizer/fullscreen.h"
#include "rasterizer/inner_area.h"
#include "rasterizer/pass.h"

namespace plumb {

// How far a blur reads, in pixels along each axis.
int blur_reach(const BilateralBlurSettings& settings);

struct BilateralBlurRequest {
    std::string name;                // of the pass
    BilateralBlurSettings settings;  // radius > 0
    float quantity_radius = 1.0f;    // metres
    std::string input, output;       // planes, without a layer's prefix
    int layer = 0;                   // whose surfaces the planes belong to
    std::string read_beyond = {};    // see InnerArea
    bool stored_positions = false;   // the plane camera_position is read
};

class BilateralBlurPass final : public Pass {
public:
    BilateralBlurPass(const PassResources& resources, const BilateralBlurRequest& request);
    void execute(const PassFrame& frame) override;

private:
    const GlTexture& noisy_;
    const GlTexture& depth_;
    const GlTexture* normal_ = nullptr;    // where the kind looks at normals
    const GlTexture* position_ = nullptr;  // and at positions, and they are stored
    const GlTexture* keys_ = nullptr;      // where depths are compared by keys
    int layer_;
    const GlTexture& half_blurred_;  // all blurs of a pipeline share one for each format
    FullscreenDraw along_rows_, along_columns_;
    GlFramebuffer half_blurred_target_, target_;
    InnerArea area_of_rows_, area_;
};

PassDeclaration declare_bilateral_blur(const BilateralBlurRequest& request);

}  // namespace plumb

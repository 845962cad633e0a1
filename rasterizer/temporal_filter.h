// Averages a filtered plane over frames along the motion of the surfaces.
//
// The point X that a pixel shows is looked for in the frame before (reprojection.glsl), between four pixels i of it
// with the bilinear weights b_i:
//
//     E_t = E (1 - w) + sum_i w_i E_(t-1),i        w = sum_i w_i
//     w_i = alpha b_i (1 - smoothstep(reject_from, reject_to, d_i))
//
// d_i, in metres, is the distance from the surface that the frame before had; the nearer one of both layers where
// `layers` is 2:
//     plane     how far that surface lies, along the ray through pixel i, from the plane through X (where X was then)
//               with the normal that X had then
//     mara2016  how far X, where it was then, lies from the point that was shown in its place, the same for all i: on
//               the ray to X, as deep as the surface in the pixel that X falls into. Without such a pixel there is no
//               history. It rejects far and slanted surfaces for the half pixel that X is off the grid.
//   Sources: alpha and the rule "within 1 cm of either layer": Mara et al. 2016, "Deep G-Buffers for Stable Global
//   Illumination Approximation" (alpha 0.85; 0.95 and more lags; reject_from = reject_to = 0.01, layers = 2); the soft
//   limits 0.05 and 0.07 m, one layer: the temporal filter that its authors ship with G3D (alpha 0.92). Both measure
//   the distance of points; where between pixels their depth is read is theirs to know (a sampler's setting).
//
// What is kept is that of the pixels of the same layer. With layers = 2 a point that has just come to light takes over
// what its occluder received, as the paper has it.
// The history is looked up bilinearly, not at the nearest pixel: that would leave it in place while surfaces move less
// than half a pixel a frame, so that it lags behind, and by half-pixel jumps when they move more. What four pixels blur
// is little beside the filter before.
//   Good for: the noise of few taps: its variance falls to (1 - alpha) / (1 + alpha) where taps are independent from
//   frame to frame. Bad for: light and occluders that change where the surface does not move: they lag by
//   alpha / (1 - alpha) frames.
//
// There is no history of pixels outside the image (or of the guard band where the plane is not made there), of
// background, and on first frames and cuts: E_t = E, bit for bit.
#pragma once

#include <string>
#include <string_view>

#include "rasterizer/fullscreen.h"
#include "rasterizer/inner_area.h"
#include "rasterizer/reprojection.h"

namespace plumb {

struct TemporalFilterRequest {
    std::string name;   // of the pass
    std::string group;  // of its parameters, for errors: "ao.temporal"
    TemporalFilterSettings settings;
    std::string input, output;     // planes, without a layer's prefix
    int layer = 0;                 // whose surfaces the planes belong to
    std::string weight = {};       // plane of w, R32F, made where somebody reads it
    std::string read_beyond = {};  // see InnerArea
};

class TemporalFilterPass final : public Pass {
public:
    // Throws MethodError for parameters out of range.
    TemporalFilterPass(const PassResources& resources, const TemporalFilterRequest& request);
    void execute(const PassFrame& frame) override;

private:
    const GlTexture& noisy_;
    const GlTexture& depth_;
    const GlTexture* normal_;  // where distances are those from a plane
    const GlTexture& previous_depth_;
    bool is_first_;  // of the passes that fill the layers of the output
    Reprojection reprojection_;
    InnerArea area_;
    const GlTexture& output_;
    const PlaneHistory& history_;
    FullscreenDraw draw_;
    GlFramebuffer target_;
};

std::string_view to_string(HistoryRejection rejection);

// Whether the taps that the filter averages are others in each frame.
bool taps_vary(const TemporalFilterSettings& settings);

PassDeclaration declare_temporal_filter(const Scene& scene, const TemporalFilterRequest& request);

}  // namespace plumb

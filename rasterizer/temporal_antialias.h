// Anti-aliasing over frames: every frame is rendered with its pixels moved by a part of one, and the colours of what
// was seen there before are averaged along the motion of the surfaces.
//
// The offsets are the first jitter_length points of the Halton sequence in the bases 2 and 3, less their mean, so that
// the average is not displaced. The whole frame is rendered with them (View::with_offset), and all planes stay as they
// were rendered, moved, but `total`, which belongs to the pixels of the view without an offset:
//
//     total_t = mix(C(history), c, max(1 - alpha, 1 / n))
//
// c is the colour that this frame has at the pixel, n counts the frames that were averaged there with this one, and
// `history` is total_(t-1) where the pixel's surface was then. C holds it within the least and the greatest value, per
// channel, of this frame's colours at the pixel and its eight neighbours (`clamp`). The surface is the one seen at the
// pixel, or, with `dilate`, the nearest at the pixel and its neighbours: the smoothed edge of an object then moves with
// the object. n = 1 where there is no history: outside the image, behind the camera, on first frames and cuts.
// Without `reprojection`, `history` is total_(t-1) at the same pixel, whatever has moved: an average of frames, which
// leaves ghosts of all that does.
//
// Without `clamp`, a still view's average is the exact mean of its frames until n reaches 1 / (1 - alpha); a box over
// the pixel, as the path tracer's anti-aliased mode has it. With `clamp`, thin bright things that some offsets miss are
// darkened whenever they are missed.
//   Sources: Karis 2014, "High-Quality Temporal Supersampling" (jitter, clamp, dilation; his weights by tone-mapped
//   brightness are left out: what is measured here is linear); Yang, Liu, Salvi 2020, "A Survey of Temporal
//   Antialiasing Techniques" (the count n, the Catmull-Rom lookup). Good for: edges and textures in still and slow
//   views. Bad for: motion of more than the history can follow (mirrors, transparency, moving shadows: their colours
//   are followed as if painted on the surface).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rasterizer/fullscreen.h"
#include "rasterizer/inner_area.h"
#include "rasterizer/reprojection.h"

namespace plumb {

// By which the pixels of successive frames are moved, from a cut on and then again from the first: in pixels, each
// coordinate between -1 and 1.
std::vector<glm::vec2> jitter_offsets(const AntialiasSettings& settings);

// What the composite writes: `total`, or what this pass makes `total` of.
std::string composited_plane(const Method& method);
constexpr std::string_view aliased_plane = "total.aliased";

class TemporalAntialiasPass final : public Pass {
public:
    explicit TemporalAntialiasPass(const PassResources& resources);
    void execute(const PassFrame& frame) override;

private:
    const GlTexture& aliased_;
    // Without reprojection none.
    const GlTexture* depth_;
    std::optional<Reprojection> reprojection_;
    InnerArea area_;
    const GlTexture& resolved_;
    const PlaneHistory& history_;
    FullscreenDraw draw_;
    GlFramebuffer target_;
};

PassDeclaration declare_temporal_antialias(const Scene& scene, const Method& method);

}  // namespace plumb

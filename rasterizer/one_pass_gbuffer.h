// Both layers of the deep G-buffer in one geometry pass.
//
// Every triangle is sent to both layers of the targets. Layer 1 is the G-buffer as ever. A fragment of layer 2 is kept
// where it lies more than the minimum separation behind the first layer. That one is only being drawn, so the test is
// made against another depth, and the variants differ in which:
//
//   delay      layer 1 of this frame, drawn with the last frame into a third layer, depth only: whoever renders tells a
//              frame ahead where camera and instances will be (FrameRequest::next), that is, shows frames one frame
//              late. Exact: the layers are those of peeling, bit for bit.
//   predict    the same third layer, drawn where camera and instances would be if they went on as they moved
//              (moment.h). Exact for constant velocity; what accelerates is off by its acceleration over one frame.
//   previous   layer 1 of the previous frame, at the same pixel. Guarantees nothing where anything moves.
//   reproject  layer 1 of the previous frame, at the pixel where the fragment's point was then, against the depth that
//              it had then: the separation is that of the previous frame, between points that were visible then. Wrong
//              at what the first layer newly shows or hides, and, since the depth is that of the nearest pixel's
//              centre, on surfaces so slanted that half a pixel changes their depth by the separation.
//
// A fragment whose comparison is missing is dropped: it was outside the previous image, behind the previous camera, or
// in front of nothing. All four find the layers of peeling where nothing moves. The comparison of the inexact ones may
// be nearer than the first layer, and layer 2 then repeats layer 1, or farther, and it then lacks surfaces; a
// separation smaller than the minimum is possible.
//
// On the first frame and on cuts (PassFrame::continues, PassFrame::foretold) there is no comparison. It is drawn first
// then, by a pass of its own over the geometry, depth only: such a frame costs two passes and is exact. Depth and what
// is kept of it for the next frame trade places frame by frame; nothing is copied or allocated.
//   Source: Mara et al. 2016, "Deep G-Buffers for Stable Global Illumination Approximation", algorithm 2.
//
// Layers are selected by a geometry shader that emits every triangle several times, or by the vertex shader of several
// instances (GL_ARB_shader_viewport_layer_array). A layered target has the same number of layers everywhere: with
// `delay` and `predict` the third one exists in every plane, though only its depth is used; later passes take its
// memory (plane_pool.h).
#pragma once

#include <string_view>

#include "rasterizer/gbuffer_draw.h"

namespace plumb {

std::string_view to_string(LayerGeneration generation);

class OnePassGBuffer final : public Pass {
public:
    // Throws GlError where the method selects layers in the vertex shader and OpenGL cannot.
    explicit OnePassGBuffer(const PassResources& resources);
    void execute(const PassFrame& frame) override;

private:
    bool looks_ahead() const;
    int layer_count() const { return looks_ahead() ? 3 : 2; }
    // The layer of the last frame's depth that holds what fragments are compared with.
    int comparison_layer() const { return looks_ahead() ? 2 : 0; }
    const GlTexture& create_planes(const PassResources& resources) const;
    ShaderDefines defines() const;
    void draw_comparison(const Frustum& frustum) const;

    GlContext& context_;
    const GBufferSettings settings_;
    DepthTest test_;
    const GlTexture& depth_;
    const PlaneHistory& history_;  // of the depth
    const GlTexture& buffer_;      // the hardware's
    GBufferTargets targets_;
    GBufferDraw draw_, comparison_draw_;
    BackgroundDraw background_;
    GlFramebuffer layers_target_, comparison_target_;
};

}  // namespace plumb

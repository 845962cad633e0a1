// A fixed piece of OpenGL work that machines are told apart by.
//
// The time of a method means nothing on another machine; as a ratio to the time of this work, measured on the same
// driver in turn with it, it does: the machine's speed cancels. The work is what methods are made of: many small
// triangles with a depth test (as a G-buffer), then scattered texture reads with arithmetic around each pixel (as
// screen-space gathers). It depends on no scene, no method and no setting, so that a change which slows all methods
// down shows, as it would not if one method were told by another. It is OpenGL alone, because a ratio of a GPU's time
// to a CPU's would differ from machine to machine.
//   Good for: the same kind of driver. Bad for: comparing a GPU with a software rasteriser, which weigh triangles
//   against reads differently; costs are to be calibrated anew there.
#pragma once

#include "rasterizer/fullscreen.h"
#include "rasterizer/pass_timer.h"

namespace plumb {

// Raise it with any change of the work: costs that were calibrated by another version are then refused.
inline constexpr int calibrating_workload_version = 1;

class CalibratingWorkload {
public:
    explicit CalibratingWorkload(GlContext& context);

    // Milliseconds of doing the work once. It is done as often as makes up `least_milliseconds`, so that a fast
    // machine's clock can tell.
    double milliseconds(double least_milliseconds = 10.0);

    // What the work leaves behind, for tests: RGBA16F.
    const GlTexture& result() const { return gathered_; }
    // Does the work once.
    void draw() const;

private:
    static constexpr int size = 256;   // pixels, both ways
    static constexpr int cells = 128;  // of two triangles, both ways
    static constexpr int taps = 32;    // per pixel

    GlContext& context_;
    ProgramCache programs_;
    GlTexture surface_, depth_, gathered_;
    GlFramebuffer surface_target_, gathered_target_;
    const Program& triangles_;
    FullscreenDraw gather_;
    GlVertexArray no_vertices_;
    PassTimer timer_;
    int rounds_ = 1;  // that took long enough the last time
};

}  // namespace plumb

// A plane and what it held in the frame before.
//
// Two textures trade places frame by frame: the plane keeps its name and the references to it, and what it held before
// can be read from the other one. Nothing is copied, and nothing is allocated after the first frame. Who draws into the
// plane needs a framebuffer for either place.
//
// What is kept is that of the frame before only where PassFrame::continues is true; else (first frame, cut) it is
// undefined, and its reader must not look at it.
#pragma once

#include <array>
#include <functional>

#include "rasterizer/gl_objects.h"

namespace plumb {

class PlaneHistory {
public:
    // Both of one size, format and number of layers; the references must stay valid.
    PlaneHistory(GlTexture& now, GlTexture& before) : now_(&now), before_(&before) {}

    // The first thing that the pass which draws the plane does in a frame.
    void trade_places() const;
    const GlTexture& now() const { return *now_; }
    const GlTexture& before() const { return *before_; }

private:
    GlTexture *now_, *before_;
};

// What draws into a plane that may have a history: the framebuffer that goes with the plane's present place.
class PlaneTarget {
public:
    PlaneTarget() = default;
    // `make` makes the framebuffer for where the plane is; it is called once, or for either place where there is a
    // history.
    PlaneTarget(const GlTexture& plane, const PlaneHistory* history, const std::function<GlFramebuffer()>& make);

    const GlFramebuffer& now() const { return plane_->id() == first_ ? framebuffers_[0] : framebuffers_[1]; }

private:
    const GlTexture* plane_ = nullptr;
    GLuint first_ = 0;  // the texture that was the plane when this was made
    std::array<GlFramebuffer, 2> framebuffers_;
};

}  // namespace plumb

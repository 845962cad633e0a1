// A plane and what it held in the frame before.
//
// Two textures trade places frame by frame: the plane keeps its name and the references to it, and what it held before
// can be read from the other one. Nothing is copied, and nothing is allocated after the first frame. Who draws into the
// plane has a framebuffer that follows it (GlFramebuffer::id).
//
// What is kept is that of the frame before only where PassFrame::continues is true; else (first frame, cut) it is
// undefined, and its reader must not look at it.
#pragma once

#include <list>

#include "rasterizer/gl_objects.h"

namespace plumb {

class PlaneHistory {
public:
    // The plane, and the texture that takes what it held: both of one size, format and number of layers; the references
    // must stay valid. `views` and `former_views`: views of either, one for one, that trade places with them.
    PlaneHistory(GlTexture& plane, GlTexture& former, std::list<GlTexture>* views = nullptr,
                 std::list<GlTexture>* former_views = nullptr)
        : now_(&plane), before_(&former), views_of_now_(views), views_of_before_(former_views) {}

    // The first thing that the pass which draws the plane does in a frame.
    void trade_places() const;
    const GlTexture& now() const { return *now_; }
    const GlTexture& before() const { return *before_; }

private:
    GlTexture *now_, *before_;
    std::list<GlTexture>* views_of_now_;
    std::list<GlTexture>* views_of_before_;
};

}  // namespace plumb

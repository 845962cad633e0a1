#include "rasterizer/plane_history.h"

#include <utility>

namespace plumb {

void PlaneHistory::trade_places() const { std::swap(*now_, *before_); }

PlaneTarget::PlaneTarget(const GlTexture& plane, const PlaneHistory* history,
                         const std::function<GlFramebuffer()>& make)
    : plane_(&plane), first_(plane.id()) {
    framebuffers_[0] = make();
    if (!history) return;
    history->trade_places();
    framebuffers_[1] = make();
    history->trade_places();
}

}  // namespace plumb

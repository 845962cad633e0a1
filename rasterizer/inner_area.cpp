#include "rasterizer/inner_area.h"

namespace plumb {

InnerArea::InnerArea(const PassResources& resources, glm::ivec2 reach, std::string_view read_beyond)
    : context_(resources.context) {
    const glm::ivec2 size(resources.planes.width(), resources.planes.height());
    const int guard_band = resources.is_read(read_beyond) ? 0 : resources.method.gbuffer.guard_band;
    const glm::ivec2 margin = glm::max(glm::ivec2(guard_band) - reach, glm::ivec2(0));
    corner_ = margin;
    size_ = size - 2 * margin;
}

InnerArea::Restriction::Restriction(const InnerArea& area) : area_(area) {
    area.context_.gl.Enable(GL_SCISSOR_TEST);
    area.context_.gl.Scissor(area.corner_.x, area.corner_.y, area.size_.x, area.size_.y);
}

InnerArea::Restriction::~Restriction() { area_.context_.gl.Disable(GL_SCISSOR_TEST); }

}  // namespace plumb

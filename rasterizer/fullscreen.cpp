#include "rasterizer/fullscreen.h"

namespace plumb {

FullscreenDraw::FullscreenDraw(GlContext& context, ProgramCache& programs, const std::string& fragment_file,
                               const ShaderDefines& defines)
    : program_(&programs.get({"fullscreen.vert", fragment_file}, defines)), no_vertices_(context) {}

void FullscreenDraw::draw(const GlFramebuffer& target) const {
    target.bind();
    program_->use();
    no_vertices_.bind();
    target.context().gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace plumb

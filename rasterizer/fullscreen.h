// A fragment shader over every pixel of a framebuffer.
#pragma once

#include "rasterizer/shader.h"

namespace plumb {

class FullscreenDraw {
public:
    FullscreenDraw(GlContext& context, ProgramCache& programs, const std::string& fragment_file,
                   const ShaderDefines& defines = {});

    // For uniforms; set them before draw().
    const Program& program() const { return *program_; }
    // Runs the shader over the whole of `target`. Bind the input textures first.
    void draw(const GlFramebuffer& target) const;

private:
    const Program* program_;
    GlVertexArray no_vertices_;  // core profile wants one bound even where no attribute is read
};

}  // namespace plumb

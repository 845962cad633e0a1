// The C++ half of reprojection.glsl, which tells a shader where surface points were in the frame before.
//
// A pass that includes the file holds one of these, compiles its shader with its defines, binds it before it draws, and
// declares the inputs that it reads.
#pragma once

#include "rasterizer/pass.h"

namespace plumb {

class Reprojection {
public:
    // `unit`: a texture unit that the pass does not use for anything else.
    Reprojection(const PassResources& resources, GLuint unit);
    ShaderDefines defines() const;
    void bind() const;

    // What a shader reads that looks for points of `layer`, besides the depth that it hands over.
    static std::vector<std::string> inputs(const Scene& scene, int layer);

private:
    const GlTexture* moving_instance_ = nullptr;  // of scenes in which something moves
    GLuint unit_;
};

}  // namespace plumb

// SpecularAlbedo's table on the GPU: A and B of the split sum, the very numbers that the path tracer reads.
// Shaders include specular_albedo.glsl.
#pragma once

#include "rasterizer/plane_textures.h"
#include "rasterizer/shader.h"

namespace plumb {

class SpecularAlbedoTexture {
public:
    explicit SpecularAlbedoTexture(GlContext& context);

    void bind(GLuint unit) const { table_.bind(unit); }
    static ShaderDefines defines(GLuint unit);

private:
    GlTexture table_;
};

// The one table of a pipeline; whoever asks first makes it.
const GlTexture& specular_albedo_table(GlContext& context, PlaneTextures& planes);

}  // namespace plumb

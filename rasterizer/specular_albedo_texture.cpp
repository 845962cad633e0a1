#include "rasterizer/specular_albedo_texture.h"

#include <fmt/format.h>

#include "scenes/specular_albedo.h"

namespace plumb {

SpecularAlbedoTexture::SpecularAlbedoTexture(GlContext& context)
    : table_(GlTexture::flat(context, GL_RG32F, SpecularAlbedo::columns, SpecularAlbedo::rows)) {
    const SpecularAlbedo albedo;
    context.gl.TextureSubImage2D(table_.id(), 0, 0, 0, SpecularAlbedo::columns, SpecularAlbedo::rows, GL_RG, GL_FLOAT,
                                 albedo.table().data());
    table_.set_filter(GL_LINEAR, GL_LINEAR);
}

ShaderDefines SpecularAlbedoTexture::defines(GLuint unit) {
    return {{"SPECULAR_ALBEDO_UNIT", fmt::format("{}", unit)}};
}

}  // namespace plumb

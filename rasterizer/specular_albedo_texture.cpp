#include "rasterizer/specular_albedo_texture.h"

#include <fmt/format.h>

#include "scenes/specular_albedo.h"

namespace plumb {
namespace {

GlTexture make_table(GlContext& context) {
    GlTexture table = GlTexture::flat(context, GL_RG32F, SpecularAlbedo::columns, SpecularAlbedo::rows);
    const SpecularAlbedo albedo;
    context.gl.TextureSubImage2D(table.id(), 0, 0, 0, SpecularAlbedo::columns, SpecularAlbedo::rows, GL_RG, GL_FLOAT,
                                 albedo.table().data());
    table.set_filter(GL_LINEAR, GL_LINEAR);
    return table;
}

}  // namespace

SpecularAlbedoTexture::SpecularAlbedoTexture(GlContext& context) : table_(make_table(context)) {}

ShaderDefines SpecularAlbedoTexture::defines(GLuint unit) {
    return {{"SPECULAR_ALBEDO_UNIT", fmt::format("{}", unit)}};
}

const GlTexture& specular_albedo_table(GlContext& context, PlaneTextures& planes) {
    const std::string name = "specular albedo table";
    return planes.has(name) ? planes.get(name) : planes.adopt(name, make_table(context));
}

}  // namespace plumb

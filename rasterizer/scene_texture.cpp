#include "rasterizer/scene_texture.h"

#include <fmt/format.h>

#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

GLint gl_wrap(TextureWrap wrap) {
    switch (wrap) {
        case TextureWrap::clamp:
            return GL_CLAMP_TO_EDGE;
        case TextureWrap::mirror:
            return GL_MIRRORED_REPEAT;
        case TextureWrap::repeat:
            break;
    }
    return GL_REPEAT;
}

}  // namespace

GlTexture upload(GlContext& context, const Texture& texture) {
    const GladGLContext& gl = context.gl;
    context.make_current();
    GLint limit = 0;
    gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    if (texture.width > limit || texture.height > limit) {
        throw GlError(fmt::format("texture '{}' is {}x{}, this OpenGL takes {} at most; scale it down", texture.name,
                                  texture.width, texture.height, limit));
    }
    const bool wide = texture.is_wide();
    GlTexture uploaded = GlTexture::flat(context, wide ? GL_RGBA32F : GL_RGBA16F, texture.width, texture.height);
    gl.TextureSubImage2D(uploaded.id(), 0, 0, 0, texture.width, texture.height, GL_RGBA,
                         wide ? GL_FLOAT : GL_HALF_FLOAT,
                         wide ? static_cast<const void*>(texture.wide_texels.data()) : texture.texels.data());
    uploaded.set_filter(GL_LINEAR, GL_LINEAR);
    uploaded.set_wrap(gl_wrap(texture.wrap_u), gl_wrap(texture.wrap_v));
    return uploaded;
}

}  // namespace plumb

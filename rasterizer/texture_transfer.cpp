#include "rasterizer/texture_transfer.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

GLenum pixel_format(const GlTexture& texture, int channels) {
    if (texture.format() == GL_DEPTH_COMPONENT32F) return GL_DEPTH_COMPONENT;
    constexpr std::array<GLenum, 4> formats{GL_RED, GL_RG, GL_RGB, GL_RGBA};
    return formats.at(static_cast<std::size_t>(channels - 1));
}

Image flipped(const Image& image) {
    Image result(image.width(), image.height(), image.channels());
    for (int y = 0; y < image.height(); ++y) {
        const float* row = image.pixel(0, y).data();
        std::copy_n(row, static_cast<std::size_t>(image.width()) * image.channels(),
                    result.pixel(0, image.height() - 1 - y).data());
    }
    return result;
}

}  // namespace

void upload(const GlTexture& texture, int layer, const Image& image) {
    if (image.width() != texture.width() || image.height() != texture.height()) {
        throw GlError(fmt::format("an image of {}x{} does not fit a texture of {}x{}", image.width(), image.height(),
                                  texture.width(), texture.height()));
    }
    GlContext& context = texture.context();
    context.make_current();
    const Image bottom_up = flipped(image);
    const GLenum format = pixel_format(texture, image.channels());
    if (texture.target() == GL_TEXTURE_2D) {
        context.gl.TextureSubImage2D(texture.id(), 0, 0, 0, image.width(), image.height(), format, GL_FLOAT,
                                     bottom_up.values().data());
    } else {
        context.gl.TextureSubImage3D(texture.id(), 0, 0, 0, layer, image.width(), image.height(), 1, format, GL_FLOAT,
                                     bottom_up.values().data());
    }
    context.check("upload of an image");
}

Image read_back(const GlTexture& texture, int layer, int channels, int border, int level) {
    GlContext& context = texture.context();
    context.make_current();
    const int width = std::max(1, texture.width() >> level) - 2 * border;
    const int height = std::max(1, texture.height() >> level) - 2 * border;
    Image bottom_up(width, height, channels);
    context.gl.GetTextureSubImage(texture.id(), level, border, border, texture.target() == GL_TEXTURE_2D ? 0 : layer,
                                  width, height, 1, pixel_format(texture, channels), GL_FLOAT,
                                  static_cast<GLsizei>(bottom_up.values().size_bytes()), bottom_up.values().data());
    context.check("read-back of an image");
    return flipped(bottom_up);
}

}  // namespace plumb

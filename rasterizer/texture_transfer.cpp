#include "rasterizer/texture_transfer.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

GLenum pixel_format(const GlTexture& texture, int channels) {
    if (texture.format() == GL_DEPTH_COMPONENT32F) return GL_DEPTH_COMPONENT;
    constexpr std::array<GLenum, 4> formats{GL_RED, GL_RG, GL_RGB, GL_RGBA};
    return formats.at(static_cast<std::size_t>(channels - 1));
}

GLenum integer_pixel_format(int channels) {
    constexpr std::array<GLenum, 4> formats{GL_RED_INTEGER, GL_RG_INTEGER, GL_RGB_INTEGER, GL_RGBA_INTEGER};
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
    const auto write_as = [&](GLenum format, GLenum type, const void* values) {
        if (texture.target() == GL_TEXTURE_2D) {
            context.gl.TextureSubImage2D(texture.id(), 0, 0, 0, image.width(), image.height(), format, type, values);
        } else {
            context.gl.TextureSubImage3D(texture.id(), 0, 0, 0, layer, image.width(), image.height(), 1, format, type,
                                         values);
        }
    };
    if (holds_integers(texture.format())) {
        const std::vector<GLuint> integers(bottom_up.values().begin(), bottom_up.values().end());
        write_as(integer_pixel_format(image.channels()), GL_UNSIGNED_INT, integers.data());
    } else {
        write_as(pixel_format(texture, image.channels()), GL_FLOAT, bottom_up.values().data());
    }
    context.check("upload of an image");
}

Image read_back(const GlTexture& texture, int layer, int channels, int border, int level) {
    GlContext& context = texture.context();
    context.make_current();
    const int width = std::max(1, texture.width() >> level) - 2 * border;
    const int height = std::max(1, texture.height() >> level) - 2 * border;
    Image bottom_up(width, height, channels);
    const auto read_as = [&](GLenum format, GLenum type, auto values) {
        context.gl.GetTextureSubImage(texture.id(), level, border, border,
                                      texture.target() == GL_TEXTURE_2D ? 0 : layer, width, height, 1, format, type,
                                      static_cast<GLsizei>(values.size_bytes()), values.data());
    };
    if (holds_integers(texture.format())) {
        std::vector<GLuint> integers(bottom_up.values().size());
        read_as(integer_pixel_format(channels), GL_UNSIGNED_INT, std::span(integers));
        std::ranges::transform(integers, bottom_up.values().begin(), [](GLuint n) { return static_cast<float>(n); });
    } else {
        read_as(pixel_format(texture, channels), GL_FLOAT, bottom_up.values());
    }
    context.check("read-back of an image");
    return flipped(bottom_up);
}

}  // namespace plumb

#include "rasterizer/gl_objects.h"

#include <algorithm>

#include <fmt/format.h>

#include "rasterizer/gl_error.h"

namespace plumb {

GlObject::GlObject(GlContext& context, Kind kind, GLuint id, std::size_t bytes)
    : context_(&context), kind_(kind), id_(id), bytes_(bytes) {
    context.count_creation(bytes);
}

GlObject& GlObject::operator=(GlObject&& other) noexcept {
    if (this != &other) {
        destroy();
        context_ = other.context_;
        kind_ = other.kind_;
        id_ = std::exchange(other.id_, 0);
        bytes_ = std::exchange(other.bytes_, 0);
    }
    return *this;
}

void GlObject::destroy() noexcept {
    if (id_ == 0) return;
    context_->make_current();
    const GladGLContext& gl = context_->gl;
    switch (kind_) {
        case Kind::texture:
            gl.DeleteTextures(1, &id_);
            break;
        case Kind::framebuffer:
            gl.DeleteFramebuffers(1, &id_);
            break;
        case Kind::buffer:
            gl.DeleteBuffers(1, &id_);
            break;
        case Kind::vertex_array:
            gl.DeleteVertexArrays(1, &id_);
            break;
        case Kind::query:
            gl.DeleteQueries(1, &id_);
            break;
        case Kind::program:
            gl.DeleteProgram(id_);
            break;
    }
    context_->count_destruction(bytes_);
    id_ = 0;
}

std::size_t bytes_per_texel(GLenum format) {
    switch (format) {
        case GL_R8:
            return 1;
        case GL_R16F:
        case GL_R16:
        case GL_R16UI:
        case GL_RG8:
            return 2;
        case GL_R32F:
        case GL_R32UI:
        case GL_RG16:
        case GL_RG16F:
        case GL_RG16_SNORM:
        case GL_RGBA8:
        case GL_RGB10_A2:
        case GL_R11F_G11F_B10F:
        case GL_DEPTH_COMPONENT32F:
            return 4;
        case GL_DEPTH32F_STENCIL8:  // padded
        case GL_RG32F:
        case GL_RGBA16:
        case GL_RGBA16F:
            return 8;
        case GL_RGB32F:
            return 12;
        case GL_RGBA32F:
            return 16;
        default:
            throw GlError(
                fmt::format("texture format {:#x}: its size is not known; add it to bytes_per_texel", format));
    }
}

bool holds_integers(GLenum format) { return format == GL_R16UI || format == GL_R32UI; }

namespace {

GLuint create_texture(GlContext& context, GLenum target) {
    context.make_current();
    GLuint id = 0;
    context.gl.CreateTextures(target, 1, &id);
    return id;
}

// A name without a texture yet, as views want it.
GLuint create_name(GlContext& context) {
    context.make_current();
    GLuint id = 0;
    context.gl.GenTextures(1, &id);
    return id;
}

std::size_t texture_bytes(GLenum format, int width, int height, int layers, int levels) {
    std::size_t texels = 0;
    for (int level = 0; level < levels; ++level) {
        texels += static_cast<std::size_t>(std::max(1, width >> level)) * std::max(1, height >> level);
    }
    return texels * layers * bytes_per_texel(format);
}

}  // namespace

GlTexture::GlTexture(GlContext& context, GLenum target, GLenum format, int width, int height, int layers, int levels)
    : GlObject(context, Kind::texture, create_texture(context, target),
               texture_bytes(format, width, height, layers, levels)),
      target_(target),
      format_(format),
      width_(width),
      height_(height),
      layers_(layers),
      levels_(levels) {
    const GladGLContext& gl = context.gl;
    if (target == GL_TEXTURE_2D || target == GL_TEXTURE_CUBE_MAP) {
        gl.TextureStorage2D(id(), levels, format, width, height);
    } else {
        gl.TextureStorage3D(id(), levels, format, width, height, layers);
    }
    set_defaults();
    context.check(fmt::format("allocation of a {}x{}x{} texture", width, height, layers));
}

GlTexture::GlTexture(const GlTexture& array, GLenum format, int first_layer, int layers, int levels)
    : GlObject(array.context(), Kind::texture, create_name(array.context()), 0),
      target_(array.target()),
      format_(format),
      width_(array.width()),
      height_(array.height()),
      layers_(layers),
      levels_(levels) {
    context().gl.TextureView(id(), target_, array.id(), format, 0, static_cast<GLuint>(levels),
                             static_cast<GLuint>(first_layer), static_cast<GLuint>(layers));
    set_defaults();
    context().check(fmt::format("view of {} layers of a {}x{}x{} texture", layers, width_, height_, array.layers()));
}

void GlTexture::set_defaults() {
    set_filter(levels_ > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST, GL_NEAREST);
    set_wrap(GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
}

GlTexture GlTexture::view(const GlTexture& array, GLenum format, int first_layer, int layers, int levels) {
    return GlTexture(array, format, first_layer, layers, levels);
}

GlTexture GlTexture::flat(GlContext& context, GLenum format, int width, int height, int levels) {
    return GlTexture(context, GL_TEXTURE_2D, format, width, height, 1, levels);
}

GlTexture GlTexture::array(GlContext& context, GLenum format, int width, int height, int layers, int levels) {
    return GlTexture(context, GL_TEXTURE_2D_ARRAY, format, width, height, layers, levels);
}

GlTexture GlTexture::cube(GlContext& context, GLenum format, int size, int levels) {
    GlTexture texture(context, GL_TEXTURE_CUBE_MAP, format, size, size, 6, levels);
    texture.set_filter(levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR, GL_LINEAR);
    return texture;
}

GlTexture GlTexture::cube_array(GlContext& context, GLenum format, int size, int cubes) {
    return GlTexture(context, GL_TEXTURE_CUBE_MAP_ARRAY, format, size, size, 6 * cubes, 1);
}

void GlTexture::set_filter(GLint minify, GLint magnify) {
    context().make_current();
    context().gl.TextureParameteri(id(), GL_TEXTURE_MIN_FILTER, minify);
    context().gl.TextureParameteri(id(), GL_TEXTURE_MAG_FILTER, magnify);
}

void GlTexture::set_wrap(GLint wrap_u, GLint wrap_v) {
    context().make_current();
    context().gl.TextureParameteri(id(), GL_TEXTURE_WRAP_S, wrap_u);
    context().gl.TextureParameteri(id(), GL_TEXTURE_WRAP_T, wrap_v);
}

void GlTexture::bind(GLuint unit) const { context().gl.BindTextureUnit(unit, id()); }

namespace {

GLuint create_framebuffer(GlContext& context) {
    context.make_current();
    GLuint id = 0;
    context.gl.CreateFramebuffers(1, &id);
    return id;
}

void attach_texture(const GladGLContext& gl, GLuint framebuffer, GLenum point, const GlAttachment& attachment) {
    const GlTexture& texture = *attachment.texture;
    if (texture.target() == GL_TEXTURE_2D || attachment.layer < 0) {
        gl.NamedFramebufferTexture(framebuffer, point, texture.id(), attachment.level);
    } else {
        gl.NamedFramebufferTextureLayer(framebuffer, point, texture.id(), attachment.level, attachment.layer);
    }
}

}  // namespace

GlFramebuffer::GlFramebuffer(GlContext& context, std::span<const GlAttachment> colours, const GlAttachment& depth,
                             const char* purpose)
    : GlObject(context, Kind::framebuffer, create_framebuffer(context), 0) {
    const GladGLContext& gl = context.gl;
    std::vector<GLenum> draw_buffers;
    for (const GlAttachment& colour : colours) {
        const GLenum point = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(draw_buffers.size());
        attach(point, colour);
        draw_buffers.push_back(point);
        colour_formats_.push_back(colour.texture->format());
    }
    if (depth.texture != nullptr) {
        const bool has_stencil = depth.texture->format() == GL_DEPTH32F_STENCIL8;
        attach(has_stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, depth);
    }
    if (draw_buffers.empty()) {
        gl.NamedFramebufferDrawBuffer(id(), GL_NONE);
    } else {
        gl.NamedFramebufferDrawBuffers(id(), static_cast<GLsizei>(draw_buffers.size()), draw_buffers.data());
    }
    const GlAttachment& any = colours.empty() ? depth : colours.front();
    width_ = std::max(1, any.texture->width() >> any.level);
    height_ = std::max(1, any.texture->height() >> any.level);
    const GLenum status = gl.CheckNamedFramebufferStatus(id(), GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        throw GlError(fmt::format("framebuffer of '{}' ({}x{}, {} colours) is incomplete: status {:#x}", purpose,
                                  width_, height_, colours.size(), status));
    }
}

void GlFramebuffer::attach(GLenum point, const GlAttachment& attachment) {
    attach_texture(context().gl, GlObject::id(), point, attachment);
    if (attachment.texture->is_trading()) trading_.push_back({point, attachment, attachment.texture->id()});
}

GLuint GlFramebuffer::id() const {
    for (Trading& one : trading_) {
        if (one.attachment.texture->id() == one.attached) continue;
        attach_texture(context().gl, GlObject::id(), one.point, one.attachment);
        one.attached = one.attachment.texture->id();
    }
    return GlObject::id();
}

void GlFramebuffer::bind() const {
    context().make_current();
    context().gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, id());
    context().gl.Viewport(0, 0, width_, height_);
}

namespace {

constexpr std::size_t smallest_buffer = 16;

GLuint create_buffer(GlContext& context) {
    context.make_current();
    GLuint id = 0;
    context.gl.CreateBuffers(1, &id);
    return id;
}

}  // namespace

GlBuffer::GlBuffer(GlContext& context, std::size_t size, const void* data, GLbitfield flags)
    : GlObject(context, Kind::buffer, create_buffer(context), std::max(size, smallest_buffer)) {
    context.gl.NamedBufferStorage(id(), static_cast<GLsizeiptr>(bytes()), size < smallest_buffer ? nullptr : data,
                                  flags | (size < smallest_buffer ? GL_DYNAMIC_STORAGE_BIT : 0));
    if (size > 0 && size < smallest_buffer && data != nullptr) write(0, size, data);
    context.check(fmt::format("allocation of a buffer of {} bytes", bytes()));
}

void GlBuffer::write(std::size_t offset, std::size_t size, const void* data) const {
    context().make_current();
    context().gl.NamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(size), data);
}

void GlBuffer::bind(GLenum indexed_target, GLuint index) const {
    context().gl.BindBufferBase(indexed_target, index, id());
}

namespace {

GLuint create_vertex_array(GlContext& context) {
    context.make_current();
    GLuint id = 0;
    context.gl.CreateVertexArrays(1, &id);
    return id;
}

GLuint create_timer(GlContext& context) {
    context.make_current();
    GLuint id = 0;
    context.gl.CreateQueries(GL_TIME_ELAPSED, 1, &id);
    return id;
}

}  // namespace

GlVertexArray::GlVertexArray(GlContext& context)
    : GlObject(context, Kind::vertex_array, create_vertex_array(context), 0) {}

void GlVertexArray::bind() const { context().gl.BindVertexArray(id()); }

GlQuery::GlQuery(GlContext& context) : GlObject(context, Kind::query, create_timer(context), 0) {}

void GlQuery::begin() const { context().gl.BeginQuery(GL_TIME_ELAPSED, id()); }

void GlQuery::end() const { context().gl.EndQuery(GL_TIME_ELAPSED); }

double GlQuery::milliseconds() const {
    GLuint64 nanoseconds = 0;
    context().gl.GetQueryObjectui64v(id(), GL_QUERY_RESULT, &nanoseconds);
    return 1e-6 * static_cast<double>(nanoseconds);
}

}  // namespace plumb

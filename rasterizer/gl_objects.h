// Move-only owners of OpenGL objects. Storage is immutable; every owner makes its own context current before it acts
// and reports itself and the bytes it holds to the context.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "rasterizer/gl_context.h"

namespace plumb {

// The common part: a name, its context and its bytes. Must not outlive the context.
class GlObject {
public:
    GLuint id() const { return id_; }
    GlContext& context() const { return *context_; }
    std::size_t bytes() const { return bytes_; }

protected:
    enum class Kind { texture, framebuffer, buffer, vertex_array, query, program };

    GlObject() = default;
    GlObject(GlContext& context, Kind kind, GLuint id, std::size_t bytes);
    ~GlObject() { destroy(); }
    GlObject(GlObject&& other) noexcept
        : context_(other.context_),
          kind_(other.kind_),
          id_(std::exchange(other.id_, 0)),
          bytes_(std::exchange(other.bytes_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept;

private:
    void destroy() noexcept;

    GlContext* context_ = nullptr;
    Kind kind_ = Kind::texture;
    GLuint id_ = 0;
    std::size_t bytes_ = 0;
};

// Bytes of one texel of a sized internal format. Throws GlError for a format that no pass uses.
std::size_t bytes_per_texel(GLenum format);

// Whether its texels are unsigned integers, which shaders and OpenGL's functions read and write as such.
bool holds_integers(GLenum format);

// A texture of any target. Starts with nearest filtering (a cube with linear), clamped to its edge; contents are
// undefined until written.
class GlTexture : public GlObject {
public:
    GlTexture() = default;
    static GlTexture flat(GlContext& context, GLenum format, int width, int height, int levels = 1);
    static GlTexture array(GlContext& context, GLenum format, int width, int height, int layers, int levels = 1);
    static GlTexture cube(GlContext& context, GLenum format, int size, int levels);
    static GlTexture cube_array(GlContext& context, GLenum format, int size, int cubes);
    // Layers and the finest levels of an array texture, which must outlive it, as a texture of its own, read and
    // written in a format of as many bytes. Takes no memory.
    static GlTexture view(const GlTexture& array, GLenum format, int first_layer, int layers, int levels);

    GLenum target() const { return target_; }
    GLenum format() const { return format_; }
    int width() const { return width_; }
    int height() const { return height_; }
    int layers() const { return layers_; }  // cubes: 6 each
    int levels() const { return levels_; }

    // It stays where it is in memory, and may trade its contents with another one of its shape (plane_history.h).
    void set_trading() { trading_ = true; }
    bool is_trading() const { return trading_; }
    void set_filter(GLint minify, GLint magnify);
    void set_wrap(GLint wrap_u, GLint wrap_v);
    void bind(GLuint unit) const;

private:
    GlTexture(GlContext& context, GLenum target, GLenum format, int width, int height, int layers, int levels);
    GlTexture(const GlTexture& array, GLenum format, int first_layer, int layers, int levels);
    void set_defaults();

    GLenum target_ = 0, format_ = 0;
    int width_ = 0, height_ = 0, layers_ = 0, levels_ = 0;
    bool trading_ = false;
};

// One layer and level of a texture as the target of a framebuffer. `layer` -1 attaches all layers, for gl_Layer.
struct GlAttachment {
    const GlTexture* texture = nullptr;
    int layer = 0;
    int level = 0;
};

class GlFramebuffer : public GlObject {
public:
    GlFramebuffer() = default;
    // Colour attachments in the order of the fragment shader's output locations; all of one size. Throws GlError naming
    // `purpose` where OpenGL calls the framebuffer incomplete.
    GlFramebuffer(GlContext& context, std::span<const GlAttachment> colours, const GlAttachment& depth,
                  const char* purpose);
    // Binds for drawing and sets the viewport to the whole framebuffer.
    void bind() const;
    // With what its textures are now: those that trade places (GlTexture::set_trading) are attached anew where they
    // have.
    GLuint id() const;
    int width() const { return width_; }
    int height() const { return height_; }
    const std::vector<GLenum>& colour_formats() const { return colour_formats_; }

private:
    struct Trading {
        GLenum point;
        GlAttachment attachment;
        GLuint attached;
    };
    void attach(GLenum point, const GlAttachment& attachment);

    mutable std::vector<Trading> trading_;
    std::vector<GLenum> colour_formats_;  // by output location
    int width_ = 0, height_ = 0;
};

class GlBuffer : public GlObject {
public:
    GlBuffer() = default;
    // `data` may be null where GL_DYNAMIC_STORAGE_BIT lets it be written later. OpenGL has no empty buffers: at least
    // 16 bytes are allocated.
    GlBuffer(GlContext& context, std::size_t size, const void* data, GLbitfield flags = 0);
    template <typename Value>
    static GlBuffer from(GlContext& context, const std::vector<Value>& values, GLbitfield flags = 0) {
        return GlBuffer(context, values.size() * sizeof(Value), values.data(), flags);
    }
    void write(std::size_t offset, std::size_t size, const void* data) const;
    void bind(GLenum indexed_target, GLuint index) const;
};

class GlVertexArray : public GlObject {
public:
    GlVertexArray() = default;
    explicit GlVertexArray(GlContext& context);
    void bind() const;
};

// A timer query.
class GlQuery : public GlObject {
public:
    GlQuery() = default;
    explicit GlQuery(GlContext& context);
    void begin() const;
    void end() const;
    double milliseconds() const;  // waits for the result
};

}  // namespace plumb

// An OpenGL 4.5 core context without a window, with its own function table.
//
// EGL comes first (a GPU where there is one, else Mesa's software rasteriser), OSMesa (always software) second. Several
// contexts, also of both kinds, may live in one process; every wrapper object makes its own context current before it
// acts. A context belongs to the thread that created it.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <glad/gl.h>

namespace plumb {

class GlBackendContext;

enum class GlBackend { automatic, egl, osmesa };
std::string_view to_string(GlBackend backend);

#ifdef NDEBUG
constexpr bool gl_debug_by_default = false;
#else
constexpr bool gl_debug_by_default = true;
#endif

struct GlInfo {
    GlBackend backend = GlBackend::egl;
    std::string platform;  // how the backend was started
    std::string vendor, renderer, version;
    bool software = false;  // rasterised on the CPU
    std::vector<std::string> extensions;
    bool has_extension(std::string_view name) const;
};

// One attempt to start a context, for `plumbline doctor`.
struct GlBackendReport {
    GlBackend backend = GlBackend::egl;
    std::string platform;  // "surfaceless", "device 0", "OSMesa"
    bool starts = false;
    GlInfo info;          // where it starts
    std::string problem;  // where it does not: the reason and the package that helps
};

class GlContext {
public:
    // `automatic`: an EGL context on a GPU, else one in software, else OSMesa. Throws GlUnavailable with the reason of
    // every attempt. Debug contexts report each GL error at the call that made it.
    static std::unique_ptr<GlContext> create(GlBackend backend = GlBackend::automatic,
                                             bool debug = gl_debug_by_default);
    // Starts each context that the machine might have, one after the other.
    static std::vector<GlBackendReport> probe();

    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    // The function table: context.gl.DrawArrays(...).
    GladGLContext gl{};

    void make_current();
    const GlInfo& info() const { return info_; }
    bool debug() const { return debug_; }

    // Throws GlError with `pass` and the messages or error codes that have gathered since the last check.
    void check(std::string_view pass);

    // Bytes that the wrapper objects of this context hold in textures and buffers, as their formats say.
    std::size_t allocated_bytes() const { return allocated_bytes_; }
    // How many wrapper objects of any kind have ever been created, those that are gone included.
    std::size_t created_objects() const { return created_objects_; }
    void count_creation(std::size_t bytes) { ++created_objects_, allocated_bytes_ += bytes; }
    void count_destruction(std::size_t bytes) { allocated_bytes_ -= bytes; }

private:
    GlContext(std::unique_ptr<GlBackendContext> backend_context, GlBackend backend, bool debug);
    static void GLAD_API_PTR on_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                        const GLchar* message, const void* self);

    std::unique_ptr<GlBackendContext> backend_context_;
    GlInfo info_;
    bool debug_;
    std::size_t allocated_bytes_ = 0, created_objects_ = 0;
    std::string messages_;
};

}  // namespace plumb

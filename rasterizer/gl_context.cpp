#include "rasterizer/gl_context.h"

#include <algorithm>

#include <fmt/format.h>

#include "rasterizer/gl_backend.h"
#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

// What OpenGL itself keeps per thread. EGL and OSMesa share Mesa's dispatch table but not each other's notion of the
// current context: without this, EGL would skip a switch back to a context that it believes to be current.
thread_local GlBackendContext* current_on_this_thread = nullptr;

void release_current() {
    if (current_on_this_thread != nullptr) current_on_this_thread->release();
    current_on_this_thread = nullptr;
}

bool is_software(std::string_view renderer) {
    return std::ranges::any_of(std::initializer_list<std::string_view>{"llvmpipe", "softpipe", "swrast", "SWR"},
                               [&](std::string_view name) { return renderer.find(name) != std::string_view::npos; });
}

std::string text(const GLubyte* from_gl) { return from_gl ? reinterpret_cast<const char*>(from_gl) : "unknown"; }

std::string_view error_name(GLenum error) {
    switch (error) {
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY:
            return "GL_OUT_OF_MEMORY";
        default:
            return "an unnamed GL error";
    }
}

}  // namespace

std::string_view to_string(GlBackend backend) {
    switch (backend) {
        case GlBackend::automatic:
            return "automatic";
        case GlBackend::egl:
            return "egl";
        case GlBackend::osmesa:
            return "osmesa";
    }
    return "";
}

bool GlInfo::has_extension(std::string_view name) const {
    return std::ranges::find(extensions, name) != extensions.end();
}

GlContext::GlContext(std::unique_ptr<GlBackendContext> backend_context, GlBackend backend, bool debug)
    : backend_context_(std::move(backend_context)), debug_(debug) {
    make_current();
    // glad's loader with a user pointer: the context whose functions are asked for.
    const auto load = [](void* from, const char* name) -> GLADapiproc {
        return reinterpret_cast<GLADapiproc>(static_cast<GlBackendContext*>(from)->function(name));
    };
    const int version = gladLoadGLContextUserPtr(&gl, load, backend_context_.get());
    if (version < GLAD_MAKE_VERSION(4, 5)) {
        const std::string platform = backend_context_->description();
        release_current();
        throw GlUnavailable(fmt::format("{}: OpenGL {}.{} is there, 4.5 core is needed", platform,
                                        GLAD_VERSION_MAJOR(version), GLAD_VERSION_MINOR(version)));
    }
    info_.backend = backend;
    info_.platform = backend_context_->description();
    info_.vendor = text(gl.GetString(GL_VENDOR));
    info_.renderer = text(gl.GetString(GL_RENDERER));
    info_.version = text(gl.GetString(GL_VERSION));
    info_.software = is_software(info_.renderer);
    GLint extensions = 0;
    gl.GetIntegerv(GL_NUM_EXTENSIONS, &extensions);
    for (GLint i = 0; i < extensions; ++i) {
        info_.extensions.push_back(text(gl.GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i))));
    }
    if (debug_) {
        gl.Enable(GL_DEBUG_OUTPUT);
        gl.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        gl.DebugMessageCallback(&GlContext::on_message, this);
    }
    gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    check("start of the context");
}

GlContext::~GlContext() {
    if (current_on_this_thread == backend_context_.get()) release_current();
}

void GlContext::make_current() {
    if (current_on_this_thread == backend_context_.get()) return;
    release_current();
    backend_context_->make_current();
    current_on_this_thread = backend_context_.get();
}

std::unique_ptr<GlContext> GlContext::create(GlBackend backend, bool debug) {
    std::string problems;
    const auto attempt = [&](GlBackend kind, auto start) -> std::unique_ptr<GlContext> {
        try {
            return std::unique_ptr<GlContext>(new GlContext(start(), kind, debug));
        } catch (const GlUnavailable& problem) {
            problems += fmt::format("{}{}", problems.empty() ? "" : "\n", problem.what());
            return nullptr;
        }
    };
    if (backend != GlBackend::osmesa) {
        std::unique_ptr<GlContext> in_software;
        for (int platform = 0; platform < egl_platform_count(); ++platform) {
            std::unique_ptr<GlContext> context = attempt(GlBackend::egl, [&] { return start_egl(platform, debug); });
            if (context && !context->info().software) return context;
            if (context && !in_software) in_software = std::move(context);
        }
        if (in_software) {
            in_software->make_current();
            return in_software;
        }
    }
    if (backend != GlBackend::egl) {
        if (std::unique_ptr<GlContext> context = attempt(GlBackend::osmesa, start_osmesa)) return context;
    }
    throw GlUnavailable(fmt::format("no OpenGL 4.5 context starts (backend {}):\n{}", to_string(backend), problems));
}

std::vector<GlBackendReport> GlContext::probe() {
    std::vector<GlBackendReport> reports;
    const auto attempt = [&](GlBackend kind, std::string platform, auto start) {
        GlBackendReport report{kind, std::move(platform), false, {}, {}};
        try {
            const std::unique_ptr<GlContext> context(new GlContext(start(), kind, false));
            report.info = context->info();
            report.starts = true;
        } catch (const GlUnavailable& problem) {
            report.problem = problem.what();
        }
        reports.push_back(std::move(report));
    };
    for (int platform = 0; platform < egl_platform_count(); ++platform) {
        attempt(GlBackend::egl, platform == 0 ? "surfaceless" : fmt::format("device {}", platform - 1),
                [&] { return start_egl(platform, false); });
    }
    attempt(GlBackend::osmesa, "OSMesa", start_osmesa);
    return reports;
}

void GLAD_API_PTR GlContext::on_message(GLenum, GLenum type, GLuint, GLenum, GLsizei length, const GLchar* message,
                                        const void* self) {
    if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) return;
    // The context registered itself with this pointer; OpenGL only hands it back as const.
    std::string& messages = static_cast<GlContext*>(const_cast<void*>(self))->messages_;
    if (!messages.empty()) messages += "; ";
    messages.append(message, length < 0 ? std::char_traits<char>::length(message) : static_cast<std::size_t>(length));
}

void GlContext::check(std::string_view pass) {
    std::string problems;
    for (GLenum error = gl.GetError(); error != GL_NO_ERROR; error = gl.GetError()) {
        problems += fmt::format("{}{}", problems.empty() ? "" : ", ", error_name(error));
    }
    if (!messages_.empty()) {
        problems += fmt::format("{}{}", problems.empty() ? "" : ": ", messages_);
        messages_.clear();
    }
    if (!problems.empty()) throw GlError(fmt::format("pass '{}': {}", pass, problems));
}

}  // namespace plumb

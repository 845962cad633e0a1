#include <array>
#include <string_view>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include "rasterizer/gl_backend.h"
#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

std::string_view error_name(EGLint error) {
    switch (error) {
        case EGL_NOT_INITIALIZED:
            return "EGL_NOT_INITIALIZED";
        case EGL_BAD_ALLOC:
            return "EGL_BAD_ALLOC";
        case EGL_BAD_ATTRIBUTE:
            return "EGL_BAD_ATTRIBUTE";
        case EGL_BAD_CONFIG:
            return "EGL_BAD_CONFIG";
        case EGL_BAD_CONTEXT:
            return "EGL_BAD_CONTEXT";
        case EGL_BAD_DISPLAY:
            return "EGL_BAD_DISPLAY";
        case EGL_BAD_MATCH:
            return "EGL_BAD_MATCH";
        case EGL_BAD_PARAMETER:
            return "EGL_BAD_PARAMETER";
        default:
            return "an unnamed EGL error";
    }
}

[[noreturn]] void fail(std::string_view step, std::string_view platform) {
    throw GlUnavailable(
        fmt::format("EGL ({}): {} failed with {}; a driver with OpenGL 4.5 core is needed (Debian "
                    "packages libegl1 and libgl1-mesa-dri bring Mesa's software one)",
                    platform, step, error_name(eglGetError())));
}

bool has_client_extension(std::string_view name) {
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    return extensions != nullptr && std::string_view(extensions).find(name) != std::string_view::npos;
}

std::vector<EGLDeviceEXT> devices() {
    if (!has_client_extension("EGL_EXT_device_enumeration") && !has_client_extension("EGL_EXT_device_base")) return {};
    const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    EGLint count = 0;
    if (query == nullptr || query(0, nullptr, &count) == EGL_FALSE || count == 0) return {};
    std::vector<EGLDeviceEXT> found(static_cast<std::size_t>(count));
    if (query(count, found.data(), &count) == EGL_FALSE) return {};
    found.resize(static_cast<std::size_t>(count));
    return found;
}

class EglContext final : public GlBackendContext {
public:
    EglContext(EGLDisplay display, std::string platform, bool debug) : display_(display) {
        EGLint major = 0, minor = 0;
        if (eglInitialize(display_, &major, &minor) == EGL_FALSE) fail("eglInitialize", platform);
        const char* vendor = eglQueryString(display_, EGL_VENDOR);
        description_ = fmt::format("EGL {}.{}, {} ({})", major, minor, platform, vendor ? vendor : "unknown vendor");
        if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) fail("eglBindAPI(EGL_OPENGL_API)", platform);
        const std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        if (eglChooseConfig(display_, wanted.data(), &config, 1, &count) == EGL_FALSE || count == 0) {
            fail("eglChooseConfig", platform);
        }
        const std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                               4,
                                               EGL_CONTEXT_MINOR_VERSION,
                                               5,
                                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                               EGL_CONTEXT_OPENGL_DEBUG,
                                               debug ? EGL_TRUE : EGL_FALSE,
                                               EGL_NONE};
        context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, attributes.data());
        if (context_ == EGL_NO_CONTEXT) fail("eglCreateContext for OpenGL 4.5 core", platform);
    }
    // The display stays initialised: EGL shares it within the process without counting its users, so that terminating
    // it here would take it from under other contexts.
    ~EglContext() override { eglDestroyContext(display_, context_); }
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

    void make_current() override {
        eglBindAPI(EGL_OPENGL_API);
        if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
            fail("eglMakeCurrent without a surface", description_);
        }
    }
    void release() override { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
    GlFunction function(const char* name) const override { return eglGetProcAddress(name); }
    std::string description() const override { return description_; }

private:
    EGLDisplay display_;
    EGLContext context_ = EGL_NO_CONTEXT;
    std::string description_;
};

}  // namespace

int egl_platform_count() { return 1 + static_cast<int>(devices().size()); }

std::unique_ptr<GlBackendContext> start_egl(int platform, bool debug) {
    if (platform == 0) {
        if (!has_client_extension("EGL_MESA_platform_surfaceless")) {
            throw GlUnavailable(
                "EGL (surfaceless): the extension EGL_MESA_platform_surfaceless is missing (Debian "
                "packages libegl1 and libegl-mesa0 bring it)");
        }
        const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (display == EGL_NO_DISPLAY) fail("eglGetPlatformDisplay", "surfaceless");
        return std::make_unique<EglContext>(display, "surfaceless", debug);
    }
    const std::vector<EGLDeviceEXT> found = devices();
    const std::string name = fmt::format("device {}", platform - 1);
    if (platform > static_cast<int>(found.size())) {
        throw GlUnavailable(fmt::format("EGL ({}): there are {} EGL devices", name, found.size()));
    }
    const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, found[platform - 1], nullptr);
    if (display == EGL_NO_DISPLAY) fail("eglGetPlatformDisplay", name);
    return std::make_unique<EglContext>(display, name, debug);
}

}  // namespace plumb

#include <array>
#include <vector>

#include <GL/osmesa.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include "rasterizer/gl_backend.h"
#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

constexpr const char* package_hint = "(Debian package libosmesa6 brings it)";

// libOSMesa, opened at run time so that the program also starts where it is not installed.
class OsMesaLibrary {
public:
    OsMesaLibrary() {
        std::string reasons;
        for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6"}) {
            handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
            if (handle_ != nullptr) {
                name_ = name;
                return;
            }
            const char* reason = dlerror();
            reasons += fmt::format("{}{}", reasons.empty() ? "" : "; ", reason ? reason : name);
        }
        throw GlUnavailable(fmt::format("OSMesa: {} {}", reasons, package_hint));
    }
    // Never closed: Mesa registers handlers that run at exit and would then call into unmapped memory.
    template <typename Function>
    Function symbol(const char* name) const {
        void* address = dlsym(handle_, name);
        if (address == nullptr) {
            throw GlUnavailable(
                fmt::format("OSMesa: {} has no {}; version 12 or later is needed {}", name_, name, package_hint));
        }
        return reinterpret_cast<Function>(address);
    }
    const std::string& name() const { return name_; }

private:
    void* handle_ = nullptr;
    std::string name_;
};

class OsMesaContext final : public GlBackendContext {
public:
    OsMesaContext()
        : create_(library_.symbol<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs")),
          destroy_(library_.symbol<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext")),
          make_current_(library_.symbol<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent")),
          function_(library_.symbol<decltype(&OSMesaGetProcAddress)>("OSMesaGetProcAddress")),
          colour_buffer_(std::size_t{4} * buffer_size * buffer_size) {
        const std::array<int, 11> attributes{OSMESA_FORMAT,
                                             OSMESA_RGBA,
                                             OSMESA_PROFILE,
                                             OSMESA_CORE_PROFILE,
                                             OSMESA_CONTEXT_MAJOR_VERSION,
                                             4,
                                             OSMESA_CONTEXT_MINOR_VERSION,
                                             5,
                                             0,
                                             0,
                                             0};
        context_ = create_(attributes.data(), nullptr);
        if (context_ == nullptr) {
            throw GlUnavailable(
                fmt::format("OSMesa: {} gives no OpenGL 4.5 core context; Mesa 20 or later is needed {}",
                            library_.name(), package_hint));
        }
    }
    ~OsMesaContext() override { destroy_(context_); }
    OsMesaContext(const OsMesaContext&) = delete;
    OsMesaContext& operator=(const OsMesaContext&) = delete;

    void make_current() override {
        if (make_current_(context_, colour_buffer_.data(), GL_UNSIGNED_BYTE, buffer_size, buffer_size) == GL_FALSE) {
            throw GlUnavailable(fmt::format("OSMesa: OSMesaMakeCurrent failed in {}", library_.name()));
        }
    }
    void release() override { make_current_(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
    GlFunction function(const char* name) const override { return function_(name); }
    std::string description() const override { return fmt::format("OSMesa, {}", library_.name()); }

private:
    // OSMesa insists on a default framebuffer; all rendering goes to framebuffer objects, so a tiny one does.
    static constexpr int buffer_size = 16;

    OsMesaLibrary library_;
    decltype(&OSMesaCreateContextAttribs) create_;
    decltype(&OSMesaDestroyContext) destroy_;
    decltype(&OSMesaMakeCurrent) make_current_;
    decltype(&OSMesaGetProcAddress) function_;
    std::vector<unsigned char> colour_buffer_;
    OSMesaContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<GlBackendContext> start_osmesa() { return std::make_unique<OsMesaContext>(); }

}  // namespace plumb

// The two ways to an OpenGL context without a window: EGL (GPU or Mesa's software rasteriser) and OSMesa (software).
#pragma once

#include <memory>
#include <string>

namespace plumb {

using GlFunction = void (*)();

// A context of one of the two libraries; no OpenGL types here, so that neither library's headers meet the loader's.
class GlBackendContext {
public:
    virtual ~GlBackendContext() = default;
    virtual void make_current() = 0;
    virtual void release() = 0;
    virtual GlFunction function(const char* name) const = 0;
    virtual std::string description() const = 0;  // "EGL 1.5, surfaceless (Mesa Project)"
};

// Throw GlUnavailable with every attempt's reason.
// `platform`: 0 is the surfaceless platform, 1 and up the EGL devices in the driver's order.
std::unique_ptr<GlBackendContext> start_egl(int platform, bool debug);
int egl_platform_count();  // 1 + number of EGL devices
std::unique_ptr<GlBackendContext> start_osmesa();

}  // namespace plumb

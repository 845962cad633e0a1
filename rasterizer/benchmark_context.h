// What the benchmarks of passes share.
#pragma once

#include <memory>

#include "rasterizer/gl_context.h"

namespace plumb {

// One for all cases of a program, without OpenGL's debug output.
inline GlContext& benchmark_context() {
    static const std::unique_ptr<GlContext> instance = GlContext::create(GlBackend::automatic, false);
    return *instance;
}

}  // namespace plumb

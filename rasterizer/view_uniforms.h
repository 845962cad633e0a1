// The uniform block of view.glsl.
#pragma once

#include "rasterizer/gl_objects.h"
#include "scenes/camera.h"

namespace plumb {

class ViewUniforms {
public:
    explicit ViewUniforms(GlContext& context);
    // The views include the guard band, which is `guard_band` pixels wide. Without a `next` one the view stays.
    // `frame_number` counts from the last cut; `pattern_shift` moves the patterns of samples (sample_spiral.h).
    void update(const View& view, const View& previous, int guard_band, const View* next = nullptr,
                int frame_number = 0, const glm::ivec2& pattern_shift = glm::ivec2(0)) const;
    void bind() const { buffer_.bind(GL_UNIFORM_BUFFER, binding); }

private:
    static constexpr GLuint binding = 0;
    GlBuffer buffer_;
};

}  // namespace plumb

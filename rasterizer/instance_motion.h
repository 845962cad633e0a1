// How the instances that move have moved since the frame before: the buffer of instance_motion.glsl, in which the plane
// `moving_instance` of the G-buffer finds its surface's motion by number.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "rasterizer/gl_objects.h"
#include "rasterizer/moment.h"

namespace plumb {

// The plane of the numbers that moving_instance_numbers() gives, for each layer.
inline constexpr const char* moving_instance_plane = "moving_instance";

bool anything_moves(const Scene& scene);
// The number of each instance of the scene among those that move, counted from 1; 0 of what stands still.
std::vector<int> moving_instance_numbers(const Scene& scene);
// The format of a plane of such numbers: with 16 bits, or 32 where more instances move.
GLenum moving_instance_format(const Scene& scene);

class InstanceMotions {
public:
    InstanceMotions(GlContext& context, const Scene& scene);
    // To be called before a frame is rendered.
    void update(const Moment& now, const Moment& previous);
    void bind() const { buffer_.bind(GL_SHADER_STORAGE_BUFFER, binding); }

private:
    // std430 layout of InstanceMotion in instance_motion.glsl.
    struct Record {
        glm::mat3x4 displacement_rows{0.0f};
        glm::mat3x4 previous_normal_from_normal{1.0f};
    };
    static_assert(sizeof(Record) == 96);
    static constexpr GLuint binding = 6;  // those of lights come before (light_buffers.h)

    const Scene& scene_;
    std::vector<Record> records_;  // by number; the first, of what stands still, is not read
    GlBuffer buffer_;
};

}  // namespace plumb

#include "rasterizer/view_uniforms.h"

#include <cstddef>

namespace plumb {
namespace {

// std140 layout of ViewBlock in view.glsl.
struct ViewBlock {
    glm::mat4 camera_from_world;
    glm::mat4 world_from_camera;
    glm::mat4 clip_from_camera;
    glm::mat4 previous_camera_from_camera;
    glm::vec2 view_size;
    glm::vec2 tan_half;
    glm::vec2 previous_tan_half;
    float near_plane;
    float far_plane;
    float pixels_per_metre;
    int first_inner_pixel;
    glm::vec2 view_shift;
    glm::mat4 next_camera_from_world;
    glm::mat4 next_clip_from_camera;
    glm::vec2 previous_view_shift;
    int frame_number;
    int padding;
    glm::ivec2 pattern_shift;
    glm::ivec2 padding_at_end;
};
static_assert(offsetof(ViewBlock, view_size) == 256 && offsetof(ViewBlock, near_plane) == 280 &&
              offsetof(ViewBlock, view_shift) == 296 && offsetof(ViewBlock, next_camera_from_world) == 304 &&
              offsetof(ViewBlock, previous_view_shift) == 432 && offsetof(ViewBlock, pattern_shift) == 448);

}  // namespace

ViewUniforms::ViewUniforms(GlContext& context) : buffer_(context, sizeof(ViewBlock), nullptr, GL_DYNAMIC_STORAGE_BIT) {}

void ViewUniforms::update(const View& view, const View& previous, int guard_band, const View* next, int frame_number,
                          const glm::ivec2& pattern_shift) const {
    ViewBlock block{};
    block.camera_from_world = view.camera_from_world();
    block.world_from_camera = view.camera().world_from_camera;
    block.clip_from_camera = view.clip_from_camera();
    // In double precision: the product of large translations leaves a small difference.
    block.previous_camera_from_camera = glm::mat4(glm::inverse(glm::dmat4(previous.camera().world_from_camera)) *
                                                  glm::dmat4(view.camera().world_from_camera));
    block.view_size = {static_cast<float>(view.width()), static_cast<float>(view.height())};
    block.tan_half = view.tan_half();
    block.previous_tan_half = previous.tan_half();
    block.near_plane = view.camera().near_plane;
    block.far_plane = view.camera().far_plane;
    block.pixels_per_metre = view.pixels_per_metre();
    block.first_inner_pixel = guard_band;
    block.view_shift = view.shift();
    block.previous_view_shift = previous.shift();
    block.frame_number = frame_number;
    block.pattern_shift = pattern_shift;
    block.next_camera_from_world = (next ? *next : view).camera_from_world();
    block.next_clip_from_camera = (next ? *next : view).clip_from_camera();
    buffer_.write(0, sizeof(block), &block);
}

}  // namespace plumb

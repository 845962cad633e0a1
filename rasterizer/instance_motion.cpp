#include "rasterizer/instance_motion.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace plumb {
namespace {

std::size_t count_of_moving(const Scene& scene) {
    return static_cast<std::size_t>(std::ranges::count_if(scene.instances, &Instance::moves));
}

}  // namespace

bool anything_moves(const Scene& scene) { return std::ranges::any_of(scene.instances, &Instance::moves); }

std::vector<int> moving_instance_numbers(const Scene& scene) {
    std::vector<int> numbers;
    int moving = 0;
    for (const Instance& instance : scene.instances) numbers.push_back(instance.moves() ? ++moving : 0);
    return numbers;
}

GLenum moving_instance_format(const Scene& scene) {
    return count_of_moving(scene) > std::numeric_limits<std::uint16_t>::max() ? GL_R32UI : GL_R16UI;
}

InstanceMotions::InstanceMotions(GlContext& context, const Scene& scene)
    : scene_(scene),
      records_(1 + count_of_moving(scene)),
      buffer_(GlBuffer::from(context, records_, GL_DYNAMIC_STORAGE_BIT)) {}

// In double precision: products of large translations leave small differences.
void InstanceMotions::update(const Moment& now, const Moment& previous) {
    if (records_.size() == 1) return;
    const glm::dmat4 world_from_camera(now.view.camera().world_from_camera);
    const glm::dmat4 camera_from_world = glm::inverse(world_from_camera);
    auto record = records_.begin() + 1;
    for (const Instance& instance : scene_.instances) {
        if (!instance.moves()) continue;
        const glm::mat4 pose = now.pose(instance), previous_pose = previous.pose(instance);
        *record = {};
        if (previous_pose != pose) {
            const glm::dmat4 moved = glm::dmat4(previous_pose) * glm::inverse(glm::dmat4(pose));
            const glm::dmat4 displacement = camera_from_world * (moved - glm::dmat4(1.0)) * world_from_camera;
            record->displacement_rows = glm::mat3x4(glm::mat4(glm::transpose(displacement)));
            const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(moved)));
            record->previous_normal_from_normal = glm::mat3x4(glm::dmat3x4(turn));
        }
        ++record;
    }
    buffer_.write(0, records_.size() * sizeof(Record), records_.data());
}

}  // namespace plumb

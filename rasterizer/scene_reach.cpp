#include "rasterizer/scene_reach.h"

namespace plumb {
namespace {

constexpr int moments_between_keys = 16;

Bounds bounds_of_motion(const Instance& instance, const Mesh& mesh) {
    Bounds object, all;
    for (const glm::vec3& p : mesh.positions) object.add(p);
    if (object.empty()) return all;
    const auto add_at = [&](double time) {
        const glm::mat4 pose = instance.pose(time);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 p(corner & 1 ? object.upper.x : object.lower.x,
                              corner & 2 ? object.upper.y : object.lower.y,
                              corner & 4 ? object.upper.z : object.lower.z);
            all.add(glm::vec3(pose * glm::vec4(p, 1.0f)));
        }
    };
    const std::vector<MotionKey>& keys = instance.motion.keys;
    add_at(keys.front().time);
    for (std::size_t i = 1; i < keys.size(); ++i) {
        const double from = keys[i - 1].time, to = keys[i].time;
        for (int k = 1; k <= moments_between_keys; ++k) add_at(from + (to - from) * k / moments_between_keys);
    }
    const glm::vec3 room(0.02f * all.diagonal());
    return {all.lower - room, all.upper + room};
}

}  // namespace

Bounds bounds_over_time(const Scene& scene) {
    Bounds all = scene.bounds();
    for (const Instance& instance : scene.instances) {
        if (instance.moves()) all.add(bounds_of_motion(instance, scene.meshes[instance.mesh]));
    }
    return all;
}

float reach(const Bounds& box, const glm::vec3& point) {
    if (box.empty()) return 1.0f;
    const glm::vec3 farthest = glm::max(glm::abs(box.lower - point), glm::abs(box.upper - point));
    return 1.01f * glm::length(farthest) + 0.01f;
}

}  // namespace plumb

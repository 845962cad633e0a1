#include "scenes/camera_path.h"

#include <algorithm>

#include <fmt/format.h>

#include "scenes/scene_error.h"

namespace plumb {
namespace {

// Cubic Hermite curve between p1 and p2 with tangents (metres per second) m1 and m2 over `span` seconds, s in [0, 1].
glm::vec3 hermite(const glm::vec3& p1, const glm::vec3& m1, const glm::vec3& p2, const glm::vec3& m2, float span,
                  float s) {
    const float s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * p1 + (s3 - 2 * s2 + s) * span * m1 + (3 * s2 - 2 * s3) * p2 + (s3 - s2) * span * m2;
}

}  // namespace

Camera CameraPath::at(float time) const {
    if (keys.empty()) throw SceneError(fmt::format("camera path '{}' has no keys", name));
    for (std::size_t i = 1; i < keys.size(); ++i) {
        if (!(keys[i].time > keys[i - 1].time)) {
            throw SceneError(fmt::format("camera path '{}': key {} at {} s does not come after key {} at {} s", name, i,
                                         keys[i].time, i - 1, keys[i - 1].time));
        }
    }
    const float t = std::clamp(time, keys.front().time, keys.back().time);
    const auto after = std::upper_bound(keys.begin(), keys.end(), t,
                                        [](float value, const CameraKey& key) { return value < key.time; });
    const std::size_t last = keys.size() - 1;
    const std::size_t i1 = std::min<std::size_t>(after - keys.begin() - 1, last == 0 ? 0 : last - 1);
    const std::size_t i2 = std::min(i1 + 1, last);
    const float span = keys[i2].time - keys[i1].time;
    const float s = span > 0.0f ? (t - keys[i1].time) / span : 0.0f;

    const auto interpolate = [&](glm::vec3 CameraKey::*member) {
        const auto tangent = [&](std::size_t i) {
            const std::size_t before = i == 0 ? 0 : i - 1, next = std::min(i + 1, last);
            if (before == next) return glm::vec3(0.0f);
            return (keys[next].*member - keys[before].*member) / (keys[next].time - keys[before].time);
        };
        return hermite(keys[i1].*member, tangent(i1), keys[i2].*member, tangent(i2), span, s);
    };
    Camera camera = Camera::look_at(fmt::format("{}@{:g}s", name, time), interpolate(&CameraKey::eye),
                                    interpolate(&CameraKey::target), vertical_fov);
    camera.near_plane = near_plane;
    camera.far_plane = far_plane;
    return camera;
}

}  // namespace plumb

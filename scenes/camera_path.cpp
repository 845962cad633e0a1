#include "scenes/camera_path.h"

#include <fmt/format.h>

#include "scenes/keyed_curve.h"
#include "scenes/scene_error.h"

namespace plumb {

Camera CameraPath::at(float time) const {
    if (keys.empty()) throw SceneError(fmt::format("camera path '{}' has no keys", name));
    check_key_times(keys, fmt::format("camera path '{}'", name));
    const KeySpan span = find_key_span(keys, time);
    const auto interpolate = [&](glm::vec3 CameraKey::*member) {
        return catmull_rom(keys, span, [member](const CameraKey& key) { return key.*member; });
    };
    const glm::vec3 eye = interpolate(&CameraKey::eye), target = interpolate(&CameraKey::target);
    Camera camera = Camera::look_at(fmt::format("{}@{:g}s", name, time), eye, target, vertical_fov);
    camera.near_plane = near_plane;
    camera.far_plane = far_plane;
    camera.aperture_radius = aperture_radius;
    camera.focus_distance = focus_distance == 0.0f ? glm::distance(eye, target) : focus_distance;
    return camera;
}

}  // namespace plumb

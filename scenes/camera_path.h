// A camera path: keys in time, smoothly interpolated.
#pragma once

#include <string>
#include <vector>

#include "scenes/camera.h"

namespace plumb {

struct CameraKey {
    float time = 0.0f;  // seconds
    glm::vec3 eye{0.0f};
    glm::vec3 target{0.0f, 0.0f, -1.0f};
};

// Eye and target follow a Catmull-Rom curve through the keys, with tangents scaled to the keys' times, so that the
// speed is continuous. Before the first key and after the last the camera stands still.
struct CameraPath {
    std::string name;
    float vertical_fov = 0.8726646f;  // radians
    float near_plane = 0.1f, far_plane = 200.0f;
    std::vector<CameraKey> keys;   // times strictly increasing
    float aperture_radius = 0.0f;  // metres, as Camera has it
    float focus_distance = 0.0f;   // metres; 0: the target is in focus, wherever it goes

    float duration() const { return keys.empty() ? 0.0f : keys.back().time - keys.front().time; }
    // Throws SceneError where there are no keys or times do not increase.
    Camera at(float time) const;
};

}  // namespace plumb

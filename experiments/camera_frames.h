// The cameras that a sequence of frames is seen by: those of a camera path at even times, or one that stands still.
//
// As a JSON file they tell any engine what to render:
//   scene, path or view, width, height, frames_per_second
//   frames   one entry each, in order:
//     time                 seconds of scene time: where objects that move are
//     eye, right, up, forward   metres and unit vectors of a right-handed world with +Y up
//     world_from_camera    4x4, rows first; the camera looks down its own -Z with +Y up, as in glTF
//     vertical_fov_degrees, near, far (metres)
//     aperture_radius, focus_distance (metres; a pinhole has radius 0)
//     fx, fy, cx, cy       intrinsics in pixels: a point (X, Y, Z) in front of the camera with X right, Y down and Z
//                          forward is seen at (fx X / Z + cx, fy Y / Z + cy), the top left pixel's centre being
//                          (0.5, 0.5)
//     clip_from_camera     4x4, rows first; OpenGL's usual one, from -w to w in depth, near plane at -w
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "scenes/camera.h"
#include "scenes/scene.h"

namespace plumb {

struct CameraSequence {
    std::string path;    // of the scene; else `view`, whose camera stands still
    std::string view;    // the scene's first where both are empty
    double start = 0.0;  // seconds of scene time
    double frames_per_second = 30.0;
    int frames = 1;
    int width = 960, height = 540;

    double time(int frame) const { return start + frame / frames_per_second; }
    // Also of frames before the first and after the last. Throws SceneError for names that are not there.
    View view_at(const Scene& scene, int frame) const;
    // "path strafe", "view front"
    std::string place(const Scene& scene) const;
};

nlohmann::ordered_json cameras_json(const Scene& scene, const std::string& scene_name, const CameraSequence& cameras);

// "eye (0.278, 0.273, 0.8), looking along (0, 0, -1), up (0, 1, 0), 39.3 degrees high"
std::string describe_camera(const Camera& camera);

}  // namespace plumb

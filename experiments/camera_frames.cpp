#include "experiments/camera_frames.h"

#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/scene_finder.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

Json json_of_vector(const glm::vec3& v) { return {v.x, v.y, v.z}; }

// Rows first, as people write them; glm keeps columns.
Json json_of_matrix(const glm::mat4& m) {
    Json rows = Json::array();
    for (int row = 0; row < 4; ++row) rows.push_back({m[0][row], m[1][row], m[2][row], m[3][row]});
    return rows;
}

glm::mat4 opengl_projection(const View& view) {
    const Camera& camera = view.camera();
    const float n = camera.near_plane, f = camera.far_plane;
    const glm::vec2 tan_half = view.tan_half();
    glm::mat4 m(0.0f);
    m[0][0] = 1.0f / tan_half.x;
    m[1][1] = 1.0f / tan_half.y;
    m[2][2] = -(f + n) / (f - n);
    m[3][2] = -2.0f * f * n / (f - n);
    m[2][3] = -1.0f;
    return m;
}

glm::vec3 axis(const Camera& camera, int column) { return glm::vec3(camera.world_from_camera[column]); }

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

Json json_of_frame(const View& view, double time) {
    const Camera& camera = view.camera();
    const double pixels_per_metre = view.pixels_per_metre();
    return {{"time", time},
            {"eye", json_of_vector(camera.position())},
            {"right", json_of_vector(axis(camera, 0))},
            {"up", json_of_vector(axis(camera, 1))},
            {"forward", json_of_vector(-axis(camera, 2))},
            {"world_from_camera", json_of_matrix(camera.world_from_camera)},
            {"vertical_fov_degrees", degrees(camera.vertical_fov)},
            {"near", camera.near_plane},
            {"far", camera.far_plane},
            {"aperture_radius", camera.aperture_radius},
            {"focus_distance", camera.focus_distance},
            {"fx", pixels_per_metre},
            {"fy", pixels_per_metre},
            {"cx", 0.5 * view.width()},
            {"cy", 0.5 * view.height()},
            {"clip_from_camera", json_of_matrix(opengl_projection(view))}};
}

}  // namespace

View CameraSequence::view_at(const Scene& scene, int frame) const {
    const Camera camera =
        path.empty() ? choose_camera(scene, view) : scene.path(path).at(static_cast<float>(time(frame)));
    return View(camera, width, height);
}

std::string CameraSequence::place(const Scene& scene) const {
    return path.empty() ? fmt::format("view {}", choose_camera(scene, view).name) : fmt::format("path {}", path);
}

Json cameras_json(const Scene& scene, const std::string& scene_name, const CameraSequence& cameras) {
    Json json = {{"scene", scene_name}};
    if (cameras.path.empty())
        json["view"] = choose_camera(scene, cameras.view).name;
    else
        json["path"] = cameras.path;
    json["width"] = cameras.width;
    json["height"] = cameras.height;
    json["frames_per_second"] = cameras.frames_per_second;
    json["frames"] = Json::array();
    for (int frame = 0; frame < cameras.frames; ++frame)
        json["frames"].push_back(json_of_frame(cameras.view_at(scene, frame), cameras.time(frame)));
    return json;
}

std::string describe_camera(const Camera& camera) {
    const glm::vec3 eye = camera.position(), forward = -axis(camera, 2), up = axis(camera, 1);
    return fmt::format(
        "eye ({:.4g}, {:.4g}, {:.4g}), looking along ({:.4g}, {:.4g}, {:.4g}), up ({:.4g}, {:.4g}, {:.4g}), "
        "{:.4g} degrees high",
        eye.x, eye.y, eye.z, forward.x, forward.y, forward.z, up.x, up.y, up.z, degrees(camera.vertical_fov));
}

}  // namespace plumb

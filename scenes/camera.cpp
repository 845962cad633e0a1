#include "scenes/camera.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "scenes/scene_error.h"

namespace plumb {

Camera Camera::look_at(std::string name, const glm::vec3& eye, const glm::vec3& target, float vertical_fov,
                       const glm::vec3& up) {
    const glm::vec3 backward = eye - target;
    const glm::vec3 right = glm::cross(up, backward);
    // Below 1e-6 of their product the cross product of float vectors is rounding noise and would give a random roll.
    if (!(glm::length(right) > 1e-6f * glm::length(up) * glm::length(backward))) {
        throw SceneError(
            fmt::format("camera '{}': eye ({}, {}, {}) and target ({}, {}, {}) coincide or lie along the up "
                        "direction; move one of them",
                        name, eye.x, eye.y, eye.z, target.x, target.y, target.z));
    }
    const glm::vec3 z = glm::normalize(backward);
    const glm::vec3 x = glm::normalize(right);
    const glm::vec3 y = glm::cross(z, x);
    Camera camera;
    camera.name = std::move(name);
    camera.vertical_fov = vertical_fov;
    camera.world_from_camera =
        glm::mat4(glm::vec4(x, 0.0f), glm::vec4(y, 0.0f), glm::vec4(z, 0.0f), glm::vec4(eye, 1.0f));
    return camera;
}

View::View(const Camera& camera, int width, int height) : camera_(camera), width_(width), height_(height) {
    if (width <= 0 || height <= 0) {
        throw SceneError(fmt::format("view '{}': size {}x{} must be positive", camera.name, width, height));
    }
    if (!(camera.near_plane > 0.0f && camera.far_plane > camera.near_plane)) {
        throw SceneError(fmt::format("camera '{}': near {} and far {} must satisfy 0 < near < far", camera.name,
                                     camera.near_plane, camera.far_plane));
    }
    if (!(camera.vertical_fov > 0.0f && camera.vertical_fov < 3.1f)) {
        throw SceneError(fmt::format("camera '{}': vertical field of view {} rad must lie between 0 and 3.1",
                                     camera.name, camera.vertical_fov));
    }
    const bool has_lens = camera.aperture_radius >= 0.0f && std::isfinite(camera.aperture_radius) &&
                          camera.focus_distance > 0.0f && std::isfinite(camera.focus_distance);
    if (!has_lens) {
        throw SceneError(
            fmt::format("camera '{}': aperture radius {} must be 0 or positive and focus distance {} positive (metres)",
                        camera.name, camera.aperture_radius, camera.focus_distance));
    }
    tan_half_height_ = std::tan(0.5f * camera.vertical_fov);
    tan_half_width_ = tan_half_height_ * static_cast<float>(width) / static_cast<float>(height);
    camera_from_world_ = glm::inverse(camera.world_from_camera);
}

View View::with_guard_band(int pixels) const {
    View wide = *this;
    wide.width_ += 2 * pixels;
    wide.height_ += 2 * pixels;
    wide.tan_half_width_ *= static_cast<float>(wide.width_) / static_cast<float>(width_);
    wide.tan_half_height_ *= static_cast<float>(wide.height_) / static_cast<float>(height_);
    return wide;
}

View View::with_offset(const glm::vec2& pixels) const {
    View moved = *this;
    moved.offset_ = pixels;
    return moved;
}

glm::vec2 View::shift() const {
    return {2.0f * offset_.x / static_cast<float>(width_), -2.0f * offset_.y / static_cast<float>(height_)};
}

glm::vec3 View::camera_space_point(float x, float y, float depth) const {
    const float u = 2.0f * (x + offset_.x) / static_cast<float>(width_) - 1.0f;
    const float v = 1.0f - 2.0f * (y + offset_.y) / static_cast<float>(height_);
    return depth * glm::vec3(u * tan_half_width_, v * tan_half_height_, -1.0f);
}

Ray View::pixel_ray(float x, float y) const {
    const glm::vec3 direction = glm::mat3(camera_.world_from_camera) * camera_space_point(x, y, 1.0f);
    return {camera_.position(), glm::normalize(direction)};
}

Ray View::lens_ray(float x, float y, const glm::vec2& lens) const {
    if (camera_.aperture_radius == 0.0f) return pixel_ray(x, y);
    const glm::vec3 on_lens(camera_.aperture_radius * lens, 0.0f);
    const glm::vec3 in_focus = camera_space_point(x, y, camera_.focus_distance);
    return {glm::vec3(camera_.world_from_camera * glm::vec4(on_lens, 1.0f)),
            glm::normalize(glm::mat3(camera_.world_from_camera) * (in_focus - on_lens))};
}

glm::vec3 View::project(const glm::vec3& world) const {
    const glm::vec3 p = glm::vec3(camera_from_world_ * glm::vec4(world, 1.0f));
    const float depth = -p.z;
    const float u = p.x / (depth * tan_half_width_);
    const float v = p.y / (depth * tan_half_height_);
    return {0.5f * (u + 1.0f) * static_cast<float>(width_) - offset_.x,
            0.5f * (1.0f - v) * static_cast<float>(height_) - offset_.y, depth};
}

glm::mat4 View::clip_from_camera() const {
    const float near_plane = camera_.near_plane, far_plane = camera_.far_plane;
    glm::mat4 clip(0.0f);
    clip[0][0] = 1.0f / tan_half_width_;
    clip[1][1] = 1.0f / tan_half_height_;
    // NDC less the shift, with w_clip = -z.
    clip[2][0] = shift().x;
    clip[2][1] = shift().y;
    // z_clip = a z + b with w_clip = -z: 1 at z = -near, 0 at z = -far.
    clip[2][2] = near_plane / (far_plane - near_plane);
    clip[3][2] = near_plane * far_plane / (far_plane - near_plane);
    clip[2][3] = -1.0f;
    return clip;
}

}  // namespace plumb

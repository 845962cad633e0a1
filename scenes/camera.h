// The camera, and the one map between pixels, rays and points that both renderers share.
//
// Right-handed world in metres, +Y up; a camera looks down its own -Z. Pixel (i, j) counts from the top left and is
// seen through its centre (i + 0.5, j + 0.5).
#pragma once

#include <string>

#include <glm/glm.hpp>

namespace plumb {

struct Ray {
    glm::vec3 origin{0.0f};
    glm::vec3 direction{0.0f, 0.0f, -1.0f};  // unit length
};

// Where a camera stands and how wide it sees; a resolution makes it a View.
struct Camera {
    std::string name;
    glm::mat4 world_from_camera{1.0f};  // rigid: rotation and translation only
    float vertical_fov = 0.8726646f;    // radians (50 degrees)
    float near_plane = 0.1f;            // metres; what the rasterizer clips, and the path tracer as well
    float far_plane = 200.0f;           // metres
    float aperture_radius = 0.0f;       // metres, of a thin lens about the camera's position; 0: a pinhole
    float focus_distance = 1.0f;        // metres along -Z: what lies there is sharp

    // A camera at `eye` that looks at `target`, upright with respect to `up`. Throws SceneError where eye and target
    // coincide or the view direction is parallel to `up`.
    static Camera look_at(std::string name, const glm::vec3& eye, const glm::vec3& target, float vertical_fov,
                          const glm::vec3& up = {0.0f, 1.0f, 0.0f});
    glm::vec3 position() const { return glm::vec3(world_from_camera[3]); }
};

// A camera seen at a resolution, optionally widened by a guard band on each side, or with its pixels displaced.
class View {
public:
    // Throws SceneError unless the sizes are positive, 0 < near < far, and the lens is one.
    View(const Camera& camera, int width, int height);

    // The same view with `pixels` more on each side; pixel (i, j) of this view is pixel (i + pixels, j + pixels) of it.
    View with_guard_band(int pixels) const;
    // The same view with its pixels moved over the image plane: (x, y) of the result sees what (x + offset.x,
    // y + offset.y) of the view without an offset sees. For sub-pixel jitter.
    View with_offset(const glm::vec2& pixels) const;

    const Camera& camera() const { return camera_; }
    int width() const { return width_; }
    int height() const { return height_; }
    const glm::mat4& camera_from_world() const { return camera_from_world_; }
    const glm::vec2& offset() const { return offset_; }  // pixels, y downwards

    // The ray through continuous pixel coordinates, from the camera's position (not from the near plane).
    Ray pixel_ray(float x, float y) const;
    // The ray through a point of the lens, given as a point of the unit disc: the rays through one (x, y) all meet at
    // depth focus_distance. Exactly pixel_ray() for a pinhole.
    Ray lens_ray(float x, float y, const glm::vec2& lens) const;
    // The point at `depth` metres along the camera's -Z, seen through (x, y), in camera space.
    glm::vec3 camera_space_point(float x, float y, float depth) const;
    // Continuous pixel coordinates (x, y) and the depth (metres along -Z) of a world point. For a depth <= 0 the point
    // is not in front of the camera and x and y mean nothing.
    glm::vec3 project(const glm::vec3& world) const;
    // Pixels per metre at 1 m depth; a length l at depth d covers l * pixels_per_metre() / d pixels.
    float pixels_per_metre() const { return 0.5f * static_cast<float>(height_) / tan_half_height_; }
    // Half the width and height of the view at 1 m depth.
    glm::vec2 tan_half() const { return {tan_half_width_, tan_half_height_}; }
    // The offset in normalised device coordinates: the middle of the view sees the camera's point `shift` of them.
    glm::vec2 shift() const;

    // Clip coordinates from camera space for OpenGL with glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE) and reversed
    // depth (near = 1, far = 0), which keeps float depth equally precise over the whole range. NDC +Y is up: image row
    // j is framebuffer row height - 1 - j.
    glm::mat4 clip_from_camera() const;

private:
    Camera camera_;
    int width_, height_;
    float tan_half_width_, tan_half_height_;
    glm::vec2 offset_{0.0f};
    glm::mat4 camera_from_world_;
};

}  // namespace plumb

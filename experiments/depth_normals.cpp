#include "experiments/depth_normals.h"

#include <array>
#include <cmath>

namespace plumb {
namespace {

constexpr std::array<glm::ivec2, 4> neighbours = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

glm::vec3 vector_at(const Image& image, const glm::ivec2& pixel) {
    return {image.at(pixel.x, pixel.y, 0), image.at(pixel.x, pixel.y, 1), image.at(pixel.x, pixel.y, 2)};
}

bool is_flat(const Frame& exact, const glm::ivec2& pixel) {
    const Image &normal = exact.plane("normal"), &instance = exact.plane("instance");
    const float here = instance.at(pixel.x, pixel.y);
    if (here < 0.0f) return false;
    for (const glm::ivec2& step : neighbours) {
        const glm::ivec2 other = pixel + step;
        // Half floats of unit length are a thousandth apart, floats a ten-millionth.
        if (instance.at(other.x, other.y) != here ||
            glm::length(vector_at(normal, other) - vector_at(normal, pixel)) > 1e-6f)
            return false;
    }
    return true;
}

glm::vec3 point_at(const Image& depth, const View& view, const glm::ivec2& pixel) {
    return view.camera_space_point(static_cast<float>(pixel.x) + 0.5f, static_cast<float>(pixel.y) + 0.5f,
                                   depth.at(pixel.x, pixel.y));
}

// From the pixel to the one of its two neighbours along an axis whose depth is nearer.
glm::vec3 step_along(const Image& depth, const View& view, const glm::ivec2& pixel, const glm::ivec2& axis) {
    const glm::ivec2 ahead = pixel + axis, behind = pixel - axis;
    const float centre = depth.at(pixel.x, pixel.y);
    const glm::vec3 point = point_at(depth, view, pixel);
    return std::abs(depth.at(ahead.x, ahead.y) - centre) <= std::abs(depth.at(behind.x, behind.y) - centre)
               ? point_at(depth, view, ahead) - point
               : point - point_at(depth, view, behind);
}

}  // namespace

double depth_normal_degrees(const Image& depth, const Frame& exact, const View& view) {
    const glm::mat3 camera_from_world = glm::transpose(glm::mat3(view.camera().world_from_camera));
    double sum = 0.0, pixels = 0.0;
    for (int y = 1; y + 1 < depth.height(); ++y) {
        for (int x = 1; x + 1 < depth.width(); ++x) {
            const glm::ivec2 pixel(x, y);
            if (!is_flat(exact, pixel)) continue;
            glm::vec3 made = glm::cross(step_along(depth, view, pixel, {1, 0}), step_along(depth, view, pixel, {0, 1}));
            if (glm::dot(made, point_at(depth, view, pixel)) > 0.0f) made = -made;
            const glm::vec3 truth = camera_from_world * vector_at(exact.plane("normal"), pixel);
            sum += std::atan2(glm::length(glm::cross(made, truth)), glm::dot(made, truth));
            ++pixels;
        }
    }
    return glm::degrees(sum / pixels);
}

}  // namespace plumb

// Cameras and image shapes that no one has chosen, for the tests that hold passes against their counterparts.
#pragma once

#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>
#include <vector>

#include <fmt/format.h>

#include "scenes/camera.h"
#include "scenes/scene.h"

namespace plumb {

// A view and the seed that makes it again.
struct RandomView {
    unsigned seed;
    View view;
};

inline std::ostream& operator<<(std::ostream& stream, const RandomView& random) {
    const Camera& camera = random.view.camera();
    const glm::vec3 eye = camera.position(), forward = -glm::vec3(camera.world_from_camera[2]);
    return stream << fmt::format("seed {}: {}x{} from ({}, {}, {}) along ({}, {}, {}), vertical field {} rad",
                                 random.seed, random.view.width(), random.view.height(), eye.x, eye.y, eye.z, forward.x,
                                 forward.y, forward.z, camera.vertical_fov);
}

// Looks from one point within the bounds at another, leaning to a side; about `pixels` pixels, up to three times as
// wide as high or as high as wide, and 25 to 90 degrees across the larger side.
inline RandomView random_view(unsigned seed, const Bounds& bounds, int pixels) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    const auto point = [&] {
        const float x = uniform(generator), y = uniform(generator), z = uniform(generator);
        return glm::mix(bounds.lower, bounds.upper, glm::vec3(x, y, z));
    };
    const glm::vec3 eye = point();
    glm::vec3 target = point();
    while (glm::length(target - eye) < 0.2f * bounds.diagonal()) target = point();
    const float aspect = std::pow(3.0f, 2.0f * uniform(generator) - 1.0f);
    const int width = static_cast<int>(std::sqrt(static_cast<float>(pixels) * aspect)), height = pixels / width;
    const float across = glm::radians(25.0f + 65.0f * uniform(generator));
    const float vertical_fov = 2.0f * std::atan(std::tan(0.5f * across) / std::max(1.0f, aspect));
    const float lean = 2.0f * uniform(generator) - 1.0f;
    const glm::vec3 up(0.5f * lean, 1.0f, 0.3f * lean);
    return {seed, View(Camera::look_at("random", eye, target, vertical_fov, up), width, height)};
}

// With seeds from `first_seed` on.
inline std::vector<RandomView> random_views(unsigned first_seed, int count, const Bounds& bounds, int pixels) {
    std::vector<RandomView> views;
    views.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) views.push_back(random_view(first_seed + static_cast<unsigned>(i), bounds, pixels));
    return views;
}

// Around the origin, for layers that are made up in camera space.
inline const Bounds anywhere{{-5.0f, -5.0f, -5.0f}, {5.0f, 5.0f, 5.0f}};

}  // namespace plumb

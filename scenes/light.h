// Lights other than emissive surfaces.
#pragma once

#include <string>

#include <glm/glm.hpp>

namespace plumb {

// The same intensity in all directions; irradiance at distance d is intensity / d^2.
struct PointLight {
    std::string name;
    glm::vec3 position{0.0f};
    glm::vec3 intensity{1.0f};  // W / sr per channel
};

// A point light within a cone; between the two half angles the intensity falls off as glTF's KHR_lights_punctual:
// clamp((cos(angle) - cos(outer)) / (cos(inner) - cos(outer)), 0, 1) squared.
struct SpotLight {
    std::string name;
    glm::vec3 position{0.0f};
    glm::vec3 direction{0.0f, -1.0f, 0.0f};  // unit length, the way light travels
    glm::vec3 intensity{1.0f};               // W / sr on the axis
    float inner_angle = 0.0f;                // half angles, radians
    float outer_angle = 0.7853982f;
};

// Parallel light.
struct DirectionalLight {
    std::string name;
    glm::vec3 direction{0.0f, -1.0f, 0.0f};  // unit length, the way light travels
    glm::vec3 irradiance{1.0f};              // W / m^2 on a surface that faces it
};

// Radiance from infinitely far away, in all directions.
struct Environment {
    glm::vec3 radiance{0.0f};  // W / (m^2 sr); multiplies the texture
    int texture = -1;          // equirectangular (Scene::textures), v = 0 straight up, u = 0.5 towards -Z; -1: constant
    float rotation = 0.0f;     // radians about +Y

    bool is_black() const { return radiance == glm::vec3(0.0f); }
    // Texture coordinates of the radiance that comes from unit `direction`.
    glm::vec2 texture_coordinates(const glm::vec3& direction) const;
};

}  // namespace plumb

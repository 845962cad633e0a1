// Lights other than emissive surfaces.
#pragma once

#include <string>

#include <glm/glm.hpp>

namespace plumb {

// How the light of a lamp falls off with distance d: 1 / (constant + linear d + quadratic d^2), where light in vacuum
// has the default, 1 / d^2. The other terms are those of older real-time renderers, for comparisons with them.
struct Attenuation {
    float constant = 0.0f;   // no unit
    float linear = 0.0f;     // 1 / m
    float quadratic = 1.0f;  // 1 / m^2

    // With constant = linear = 0 and quadratic = 1 exactly `squared_distance`.
    float divisor(float distance, float squared_distance) const {
        return constant + linear * distance + quadratic * squared_distance;
    }
    bool is_inverse_square() const { return constant == 0.0f && linear == 0.0f && quadratic == 1.0f; }
    float evaluate(float distance) const { return 1.0f / divisor(distance, distance * distance); }
};

// The same intensity in all directions; irradiance at distance d is intensity * attenuation(d), else intensity / d^2.
struct PointLight {
    std::string name;
    glm::vec3 position{0.0f};
    glm::vec3 intensity{1.0f};  // W / sr per channel
    Attenuation attenuation{};
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
    Attenuation attenuation{};
};

// Parallel light, or, with an angular radius, light from a disc of uniform radiance infinitely far away (the sun's is
// 0.00465): a cone of directions about `direction` of which every surface that faces it gets `irradiance` in all.
struct DirectionalLight {
    std::string name;
    glm::vec3 direction{0.0f, -1.0f, 0.0f};  // unit length, the way light travels
    glm::vec3 irradiance{1.0f};              // W / m^2 on a surface that faces it
    float angular_radius = 0.0f;             // radians, below pi / 2; 0: parallel
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

#include "scenes/light.h"

#include <cmath>

#include <glm/gtc/constants.hpp>

namespace plumb {

glm::vec2 Environment::texture_coordinates(const glm::vec3& direction) const {
    const float longitude = std::atan2(direction.x, -direction.z) + rotation;
    const float u = 0.5f + longitude / glm::two_pi<float>();
    const float v = std::acos(glm::clamp(direction.y, -1.0f, 1.0f)) / glm::pi<float>();
    return {u - std::floor(u), v};
}

}  // namespace plumb

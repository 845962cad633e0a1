#include "scenes/light.h"

#include <cmath>

#include <glm/gtc/constants.hpp>

namespace plumb {

glm::vec2 Environment::texture_coordinates(const glm::vec3& direction) const {
    const float longitude = std::atan2(direction.x, -direction.z) + rotation;
    const float u = 0.5f + longitude / glm::two_pi<float>();
    // Not by the cosine, which is 1 to its last digit within a hundredth of a degree.
    const float sine = std::sqrt(direction.x * direction.x + direction.z * direction.z);
    const float v = std::atan2(sine, direction.y) / glm::pi<float>();
    return {u - std::floor(u), v};
}

}  // namespace plumb

// C++ side of normal_encoding.glsl: octahedral unit vectors in [0, 1]^2.
#pragma once

#include <glm/glm.hpp>

namespace plumb {

glm::vec2 encode_normal(const glm::vec3& normal);
glm::vec3 decode_normal(const glm::vec2& encoded);

}  // namespace plumb

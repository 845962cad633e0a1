// Whether numbers and vectors are neither infinite nor NaN.
#pragma once

#include <cmath>

#include <glm/glm.hpp>

namespace plumb {

inline bool finite(float v) { return std::isfinite(v); }
inline bool finite(const glm::vec2& v) { return finite(v.x) && finite(v.y); }
inline bool finite(const glm::vec3& v) { return finite(v.x) && finite(v.y) && finite(v.z); }

}  // namespace plumb

// How bright a colour is to the eye.
#pragma once

#include <glm/glm.hpp>

namespace plumb {

// Relative luminance of linear Rec.709 (ITU-R BT.709-6, item 3.2).
inline float luminance(const glm::vec3& colour) { return glm::dot(colour, glm::vec3(0.2126f, 0.7152f, 0.0722f)); }

}  // namespace plumb

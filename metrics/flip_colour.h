// The colour spaces of FLIP (flip.h) and the difference of two colours in them.
#pragma once

#include <glm/glm.hpp>

namespace plumb {

// Of linear Rec.709's red, green and blue.
double luminance(const glm::dvec3& rgb);

// Between linear Rec.709 and the opponent space YCxCz: CIELAB without its cube roots, in which light can be blurred.
glm::vec3 opponent_from_rgb(const glm::vec3& rgb);
glm::vec3 rgb_from_opponent(const glm::vec3& opponent);

// How different two linear Rec.709 colours of 0 to 1 look, 0 to 1.
float colour_difference(const glm::vec3& test, const glm::vec3& reference);

}  // namespace plumb

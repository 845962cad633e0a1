// Maps from the unit square to directions and to triangles, with the densities that belong to them.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "pathtracer/lanes.h"

namespace plumb {

// Two unit vectors that complete `n` to a right-handed basis.
//   Source: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
PLUMBLINE_INLINE void complete_basis(const glm::vec3& n, glm::vec3& tangent, glm::vec3& bitangent) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    tangent = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    bitangent = {b, sign + n.y * n.y * a, -n.y};
}

// Sine and cosine of |angle| <= pi / 4 by their Taylor polynomials, to 4e-8; several times faster than the library's
// for all angles, and free of calls in the innermost loop.
PLUMBLINE_INLINE void small_sine_cosine(float angle, float& sine, float& cosine) {
    const float x = angle * angle;
    sine = angle * (1.0f + x * (-1.0f / 6.0f + x * (1.0f / 120.0f + x * (-1.0f / 5040.0f + x * (1.0f / 362880.0f)))));
    cosine = 1.0f + x * (-0.5f + x * (1.0f / 24.0f + x * (-1.0f / 720.0f + x * (1.0f / 40320.0f))));
}

// Uniform on the unit disc; keeps neighbours neighbours. Without branches, for loops over lanes.
//   Source: Shirley, Chiu 1997.
PLUMBLINE_INLINE glm::vec2 sample_disc(glm::vec2 u) {
    const float across = 2.0f * u.x - 1.0f, along = 2.0f * u.y - 1.0f;
    const bool wide = std::abs(across) > std::abs(along);
    const float radius = wide ? across : along, other = wide ? along : across;
    const float ratio = radius != 0.0f ? other / radius : 0.0f;
    float sine, cosine;
    small_sine_cosine(glm::quarter_pi<float>() * ratio, sine, cosine);
    return {radius * (wide ? cosine : sine), radius * (wide ? sine : cosine)};
}

// A direction about unit `normal` with density cos(theta) / pi.
PLUMBLINE_INLINE glm::vec3 sample_cosine_hemisphere(const glm::vec3& normal, glm::vec2 u) {
    glm::vec3 tangent, bitangent;
    complete_basis(normal, tangent, bitangent);
    const glm::vec2 disc = sample_disc(u);
    const float height = std::sqrt(std::max(0.0f, 1.0f - disc.x * disc.x - disc.y * disc.y));
    return disc.x * tangent + disc.y * bitangent + height * normal;
}

// 1 - cos(angle), without the digits that the subtraction loses for small angles: the height of a cap of directions,
// which covers 2 pi times as many steradians.
inline float cap_height(float angle) {
    const float sine = std::sin(0.5f * angle);
    return 2.0f * sine * sine;
}

// A direction within the cone about unit `axis` whose cap has this height, uniform per solid angle.
inline glm::vec3 sample_cone(const glm::vec3& axis, float height, glm::vec2 u) {
    glm::vec3 tangent, bitangent;
    complete_basis(axis, tangent, bitangent);
    const glm::vec2 disc = sample_disc(u);
    const float below_pole = glm::dot(disc, disc) * height;
    const glm::vec2 across = disc * std::sqrt(std::max(0.0f, height * (2.0f - below_pole)));
    return across.x * tangent + across.y * bitangent + (1.0f - below_pole) * axis;
}

// The density of its samples within the cone.
inline float cone_density(float height) { return glm::one_over_two_pi<float>() / height; }

// Barycentric weights of the second and third corner, uniform over a triangle.
//   Source: Heitz 2019, "A Low-Distortion Map Between Triangle and Square".
PLUMBLINE_INLINE glm::vec2 sample_triangle(glm::vec2 u) {
    const bool above = u.y > u.x;
    const float half = 0.5f * (above ? u.x : u.y);
    return {above ? half : u.x - half, above ? u.y - half : half};
}

// Weight of a sample drawn with density `own` where the other strategy would have had density `other`; the power
// heuristic with exponent 2 (Veach 1997, equation 9.13), written so that large densities do not overflow.
PLUMBLINE_INLINE float power_heuristic(float own, float other) {
    const float ratio = other / own;
    return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace plumb

// Where a ray met a triangle, and what lies there.
#pragma once

#include <cstdint>
#include <limits>

#include <glm/glm.hpp>

#include "pathtracer/lanes.h"

namespace plumb {

constexpr float infinite_distance = std::numeric_limits<float>::infinity();
// Any hit but one at the very origin, which Embree would count: the point may lie exactly in a coordinate plane, where
// it has no rounding error and its ray no distance from its own triangle.
constexpr float positive_distance = std::numeric_limits<float>::min();

// 20 bytes, so that the hits of a whole view can be kept.
struct SurfaceHit {
    static constexpr std::uint32_t nothing = 0xffffffffu;

    std::uint32_t instance = nothing;
    std::uint32_t triangle = nothing;
    float u = 0.0f, v = 0.0f;  // barycentric weights of the second and third corner
    float distance = infinite_distance;

    bool missed() const { return instance == nothing; }
};

// Sixteen half units in the last place: three roundings make an interpolated point (pbrt-v4, section 6.8.5), the rest
// is for the differences and the cross product in Embree's test of a triangle that is not a sliver.
constexpr float coordinate_error = 0x1p-20f;

// One triangle, counter-clockwise seen from its front also under mirroring transforms.
struct TracedTriangle {
    glm::vec3 a, b, c;
    glm::vec2 uv_a{0.0f}, uv_b{0.0f}, uv_c{0.0f};

    glm::vec3 point(float u, float v) const { return (1.0f - u - v) * a + u * b + v * c; }
    glm::vec2 uv(float u, float v) const { return (1.0f - u - v) * uv_a + u * uv_b + v * uv_c; }
    glm::vec3 scaled_normal() const { return glm::cross(b - a, c - a); }  // twice the area long
    // Rounding errors of a point on the triangle, and of Embree's test of that triangle near that point, grow with the
    // corners' coordinates, not with the point's.
    glm::vec3 error() const { return coordinate_error * glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c))); }
};

// The specular side of a surface at one point; everything 0 for a Lambertian one.
struct SpecularSurface {
    glm::vec3 f0{0.0f}, f90{0.0f};
    float alpha = 1.0f;            // as ggx_alpha gives it
    glm::vec3 transmission{0.0f};  // passes straight through

    bool has_lobe() const { return f90.x > 0.0f || f90.y > 0.0f || f90.z > 0.0f; }
    bool is_transparent() const { return transmission.x > 0.0f || transmission.y > 0.0f || transmission.z > 0.0f; }
};

// What lies at a hit, seen along a ray.
struct SurfacePoint {
    glm::vec3 position{0.0f};
    // Where a ray that leaves on the side of the geometric normal starts. Scale-free: the step is the extent of the
    // rounding error along the normal (pbrt-v4, section 6.8.6).
    glm::vec3 ray_origin{0.0f};
    glm::vec3 geometric_normal{0.0f};  // unit, on the ray's side
    glm::vec3 shading_normal{0.0f};    // unit, negated with the geometric normal
    // How far above the face, along the shading normal, the surface lies for which the face stands; 0 where it does not
    // bulge. A ray into the half space of the shading normal but not of the geometric one starts there.
    float bulge = 0.0f;
    glm::vec3 albedo{0.0f};  // 0 on the back of a one-sided surface, as is the emission
    glm::vec3 emission{0.0f};
    SpecularSurface specular;
};

}  // namespace plumb

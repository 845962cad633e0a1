// A scene as Embree sees it: triangles of every instance in world space, and what lies at the points that rays hit.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "pathtracer/embree_api.h"
#include "scenes/scene.h"

namespace plumb {

constexpr float infinite_distance = std::numeric_limits<float>::infinity();
// Any hit but one at the very origin, which Embree would count: the point may lie exactly in a coordinate plane, where
// it has no rounding error and its ray no distance from its own triangle.
constexpr float positive_distance = std::numeric_limits<float>::min();

// Where a ray met a triangle; 20 bytes, so that the hits of a whole view can be kept.
struct SurfaceHit {
    static constexpr std::uint32_t nothing = 0xffffffffu;

    std::uint32_t instance = nothing;
    std::uint32_t triangle = nothing;
    float u = 0.0f, v = 0.0f;  // barycentric weights of the second and third corner
    float distance = infinite_distance;

    bool missed() const { return instance == nothing; }
};

// What lies at a hit, seen along a ray.
struct SurfacePoint {
    glm::vec3 position{0.0f};
    glm::vec3 position_error{0.0f};    // bound of the rounding error per axis, of the position and of Embree's own test
    glm::vec3 geometric_normal{0.0f};  // unit, on the ray's side
    glm::vec3 shading_normal{0.0f};    // unit, negated with the geometric normal
    glm::vec3 albedo{0.0f};            // 0 on the back of a one-sided surface, as is the emission
    glm::vec3 emission{0.0f};

    // Where a ray that leaves on the side of the geometric normal starts. Scale-free: the step is the error's extent
    // along the normal (pbrt-v4, section 6.8.6).
    glm::vec3 ray_origin() const {
        return position + glm::dot(glm::abs(geometric_normal), position_error) * geometric_normal;
    }
};

// A corner-by-corner view of one triangle, counter-clockwise seen from its front also under mirroring transforms.
struct TracedTriangle {
    glm::vec3 a, b, c;
    glm::vec2 uv_a{0.0f}, uv_b{0.0f}, uv_c{0.0f};

    glm::vec3 point(float u, float v) const { return (1.0f - u - v) * a + u * b + v * c; }
    glm::vec2 uv(float u, float v) const { return (1.0f - u - v) * uv_a + u * uv_b + v * uv_c; }
    glm::vec3 scaled_normal() const { return glm::cross(b - a, c - a); }  // twice the area long
    // Rounding errors of a point on the triangle, and of Embree's test of that triangle near that point, grow with the
    // corners' coordinates, not with the point's.
    glm::vec3 error() const;
};

class TracedScene {
public:
    explicit TracedScene(const Scene& scene);
    ~TracedScene();
    TracedScene(const TracedScene&) = delete;
    TracedScene& operator=(const TracedScene&) = delete;

    const Scene& scene() const { return scene_; }
    const Material& material(std::uint32_t instance) const { return *parts_[instance].material; }
    std::uint32_t triangle_count(std::uint32_t instance) const { return parts_[instance].triangle_count; }

    // The nearest hit with nearest <= distance <= farthest, in units of the direction's length.
    SurfaceHit intersect(const glm::vec3& origin, const glm::vec3& direction, float nearest = positive_distance,
                         float farthest = infinite_distance, RayCoherence coherence = RayCoherence::incoherent) const;
    bool occluded(const glm::vec3& origin, const glm::vec3& direction, float farthest = infinite_distance,
                  RayCoherence coherence = RayCoherence::incoherent) const;

    SurfacePoint surface_point(const SurfaceHit& hit, const glm::vec3& ray_direction) const;
    TracedTriangle triangle(std::uint32_t instance, std::uint32_t index) const;
    // Textures looked up; the same for all points where the material has none.
    SurfaceSample surface_sample(std::uint32_t instance, const glm::vec2& uv) const;

    RTCScene embree_scene() const { return embree_scene_; }

private:
    // One instance; Embree owns positions and triangles. With a mirroring transform the second and third corner are
    // swapped, so that the winding still agrees with the normals.
    struct Part {
        const Scene* scene = nullptr;
        const Material* material = nullptr;
        const float* positions = nullptr;             // 3 per vertex
        const std::uint32_t* triangles = nullptr;     // 3 per triangle
        std::vector<glm::vec3> normals;               // world space; empty: face normals
        const std::vector<glm::vec2>* uvs = nullptr;  // null where there are none
        std::uint32_t triangle_count = 0;
        bool has_textures = false;  // false: `constant` holds for every point
        SurfaceSample constant;

        glm::vec3 position(std::uint32_t vertex) const {
            return {positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]};
        }
        glm::vec2 uv(std::uint32_t triangle, float u, float v) const;
    };

    void add(std::uint32_t index);
    static void reject_holes(const RTCFilterFunctionNArguments* arguments);

    const Scene& scene_;
    RTCDevice device_ = nullptr;
    RTCScene embree_scene_ = nullptr;
    std::vector<Part> parts_;
};

}  // namespace plumb

// A scene as Embree sees it: triangles of every instance in world space, and what lies at the points that rays hit.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "pathtracer/embree_api.h"
#include "pathtracer/embree_fingerprint.h"
#include "pathtracer/packed_textures.h"
#include "pathtracer/ray_batch.h"
#include "pathtracer/surface_hit.h"
#include "pathtracer/time_span.h"
#include "scenes/scene.h"
#include "scenes/specular_albedo.h"

namespace plumb {

class OracleLayers;
class RayRecorder;
struct CornerLanes;

class TracedScene {
public:
    // Instances that move are built with their motion over `span`; times of rays run from 0 (its begin) to 1 (its end).
    // `embree_settings`: as rtcNewDevice takes them; null: whatever the machine does best.
    explicit TracedScene(const Scene& scene, const TimeSpan& span = {}, const char* embree_settings = nullptr);
    ~TracedScene();
    TracedScene(const TracedScene&) = delete;
    TracedScene& operator=(const TracedScene&) = delete;

    const Scene& scene() const { return scene_; }
    const TimeSpan& span() const { return span_; }
    const Material& material(std::uint32_t instance) const { return *parts_[instance].material; }
    std::uint32_t triangle_count(std::uint32_t instance) const { return parts_[instance].triangle_count; }
    bool has_specular_lobes() const { return has_specular_lobes_; }
    bool has_transparency() const { return has_transparency_; }
    bool has_delta_lobes() const { return has_delta_lobes_; }  // mirrors or transparency, perhaps
    bool anything_moves() const { return anything_moves_; }
    bool moves(std::uint32_t instance) const { return parts_[instance].steps > 1; }
    // False: SurfacePoint::bulge is 0 everywhere, since no triangle's normals tell of another surface than its own.
    bool anything_bulges() const { return anything_bulges_; }

    // The nearest hit with nearest <= distance <= farthest, in units of the direction's length. Where `layers` is
    // given, here and below, only what they contain is met.
    SurfaceHit intersect(const glm::vec3& origin, const glm::vec3& direction, float nearest = positive_distance,
                         float farthest = infinite_distance, RayCoherence coherence = RayCoherence::incoherent,
                         float time = now, const OracleLayers* layers = nullptr) const;

    // Many rays at once; each finds the very hit that it finds alone.
    void intersect(const RayBatch& rays, HitBatch& hits, const OracleLayers* layers = nullptr) const;
    // Sets blocked[i] to whether anything lies between 0 and the ray's farthest point.
    void occluded(const RayBatch& rays, Lanes<int>& blocked, const OracleLayers* layers = nullptr) const;
    // What fraction of light passes: 0 where something opaque is in the way, else the product over the panes.
    void transmittance(const RayBatch& rays, VectorLanes& fraction) const;

    SurfacePoint surface_point(const SurfaceHit& hit, const glm::vec3& ray_direction, float time = now) const;
    // The same for the rays in `met`, the i-th of them into lane i of `points`, without specular parts.
    void surface_points(const RayBatch& rays, const HitBatch& hits, const MetRays& met, SurfaceLanes& points) const;
    // False where the surface may have a specular lobe or let light pass.
    bool is_plain(std::uint32_t instance) const { return parts_[instance].is_plain; }
    bool all_plain() const { return !has_specular_lobes_ && !has_transparency_; }

    // What share of light the specular lobe reflects, of what comes against `to_viewer`.
    glm::vec3 specular_albedo(const SpecularSurface& surface, const glm::vec3& shading_normal,
                              const glm::vec3& to_viewer) const;

    TracedTriangle triangle(std::uint32_t instance, std::uint32_t index, float time = now) const;
    // Textures looked up; the same for all points where the material has none.
    SurfaceSample surface_sample(std::uint32_t instance, const glm::vec2& uv) const {
        return parts_[instance].sample(uv);
    }
    // False in an alpha-masked hole.
    bool is_opaque(std::uint32_t instance, const glm::vec2& uv) const { return parts_[instance].is_opaque(uv); }

    RTCScene embree_scene() const { return embree_scene_; }
    std::uint64_t embree_fingerprint() const { return plumb::embree_fingerprint(device_); }
    // Every ray of a batch is told to `recorder` (null: none), for benchmarks.
    void set_recorder(RayRecorder* recorder) { recorder_ = recorder; }

private:
    // One instance. With a mirroring transform the second and third corner are swapped, so that the winding still
    // agrees with the normals.
    struct Part {
        const PackedTextures* textures = nullptr;
        const Material* material = nullptr;
        const glm::vec3* positions = nullptr;         // pose after pose
        const glm::vec3* normals = nullptr;           // the same; all zero: face normals
        const std::uint32_t* triangles = nullptr;     // 3 per triangle
        const std::vector<glm::vec2>* uvs = nullptr;  // null where there are none
        std::uint32_t triangle_count = 0;
        std::size_t vertex_count = 0;
        int steps = 1;              // poses over the time span, evenly spaced; in between vertices move linearly
        bool has_textures = false;  // false: `constant` holds for every point
        bool is_plain = true;       // neither a specular lobe nor transparency
        SurfaceSample constant;

        void corners(std::uint32_t triangle, float time, TracedTriangle& corners) const;
        std::array<glm::vec3, 3> corner_normals(std::uint32_t triangle, float time) const;  // 0 where there are none
        glm::vec2 uv(std::uint32_t triangle, float u, float v) const {
            if (!uvs) return {0.0f, 0.0f};
            const std::uint32_t* corners = triangles + 3 * static_cast<std::size_t>(triangle);
            return (1.0f - u - v) * (*uvs)[corners[0]] + u * (*uvs)[corners[1]] + v * (*uvs)[corners[2]];
        }
        SurfaceSample sample(const glm::vec2& uv) const;
        bool is_opaque(const glm::vec2& uv) const;
    };

    // All that a hit is made of, side by side: two cache lines, where its parts would lie in ten.
    struct alignas(32) TriangleRecord {
        std::array<glm::vec3, 3> positions, normals;
        std::array<glm::vec2, 3> uvs;  // zero where there are none
    };

    static int steps_of(const Instance& instance, const TimeSpan& span);
    void reserve(const TimeSpan& span);
    void add(std::uint32_t index, const TimeSpan& span);
    void attach(std::uint32_t index);
    void make_records();
    void gather_corners(const HitBatch& hits, const MetRays& met, CornerLanes& corners) const;
    void gather_moving_corners(const RayBatch& rays, const HitBatch& hits, const MetRays& met,
                               CornerLanes& corners) const;
    void look_up_textures(const HitBatch& hits, const MetRays& met, const CornerLanes& corners, const Lanes<float>& lit,
                          SurfaceLanes& points) const;
    void add_vertices(const Instance& instance, const Part& part, const TimeSpan& span);
    RTCScene scene_for(const OracleLayers* layers) const;  // the tree that takes a filter where there are layers
    static EmbreeQuery query_for(const OracleLayers* layers, RayCoherence coherence = RayCoherence::incoherent);
    static SurfaceHit intersect(EmbreeQuery& query, RTCScene scene, const glm::vec3& origin, const glm::vec3& direction,
                                float nearest, float farthest, float time);
    static void reject_holes(const RTCFilterFunctionNArguments* arguments);
    static void reject_what_layers_lack(const RTCFilterFunctionNArguments* arguments);

    const Scene& scene_;
    const PackedTextures textures_;
    TimeSpan span_;
    RTCDevice device_ = nullptr;
    RTCScene embree_scene_ = nullptr;
    std::vector<Part> parts_;
    // Of all parts, one after the other; Embree reads them too.
    std::vector<glm::vec3> positions_, normals_;  // world space
    std::vector<std::uint32_t> triangles_;        // vertices within the part
    std::vector<TriangleRecord> records_;         // of all triangles, where nothing moves
    // By instance, for loops over lanes.
    struct PartTable {
        std::vector<int> first_triangle;
        std::vector<float> back_is_lit;  // 1 or 0
        std::vector<glm::vec3> albedo, emission;
    } table_;
    std::optional<SpecularAlbedo> specular_albedo_;  // where there are specular lobes
    bool has_textures_ = false, has_specular_lobes_ = false, has_transparency_ = false, has_delta_lobes_ = false,
         anything_moves_ = false, has_normals_ = false, anything_bulges_ = false;
    RayRecorder* recorder_ = nullptr;
    mutable RTCScene layered_scene_ = nullptr;  // made when the first oracle asks
    mutable std::once_flag layered_scene_made_;
};

}  // namespace plumb

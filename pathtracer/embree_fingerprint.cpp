#include "pathtracer/embree_fingerprint.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/glm.hpp>
#include <xxhash.h>

#include "pathtracer/sample_sequence.h"
#include "pathtracer/surface_hit.h"

namespace plumb {
namespace {

constexpr std::size_t triangles_of_a_kind = 64;
constexpr unsigned rays_of_a_kind = 2048;
constexpr int function_values = 256;  // of each function

// Points in the unit cube, always the same.
class Points {
public:
    glm::vec3 next() { return {number(), number(), number()}; }

private:
    float number() { return static_cast<float>(mix_bits(++count_) >> 40) * 0x1p-24f; }

    std::uint64_t count_ = 0;
};

void attach_triangles(RTCDevice device, RTCScene scene, unsigned poses, Points& points) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryTimeStepCount(geometry, poses);
    for (unsigned pose = 0; pose < poses; ++pose) {
        auto* corners = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, pose, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 3 * triangles_of_a_kind));
        for (unsigned i = 0; i < 3 * triangles_of_a_kind; ++i) corners[i] = points.next();
    }
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles_of_a_kind));
    for (unsigned i = 0; i < 3 * triangles_of_a_kind; ++i) indices[i] = i;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

// Ray `i` of a packet of `width`; a single ray is laid out as a packet of one.
void set_ray(RTCRayN* rays, unsigned width, unsigned i, Points& points) {
    const glm::vec3 origin = points.next(), direction = points.next() - origin;
    RTCRayN_org_x(rays, width, i) = origin.x, RTCRayN_dir_x(rays, width, i) = direction.x;
    RTCRayN_org_y(rays, width, i) = origin.y, RTCRayN_dir_y(rays, width, i) = direction.y;
    RTCRayN_org_z(rays, width, i) = origin.z, RTCRayN_dir_z(rays, width, i) = direction.z;
    RTCRayN_tnear(rays, width, i) = positive_distance, RTCRayN_tfar(rays, width, i) = infinite_distance;
    RTCRayN_time(rays, width, i) = points.next().x;
    RTCRayN_mask(rays, width, i) = 0xffffffffu, RTCRayN_id(rays, width, i) = 0, RTCRayN_flags(rays, width, i) = 0;
}

class Bits {
public:
    template <typename Value>
    void add(const Value& value) {
        const auto* begin = reinterpret_cast<const std::byte*>(&value);
        bytes_.insert(bytes_.end(), begin, begin + sizeof value);
    }
    std::uint64_t hash() const { return XXH3_64bits_withSeed(bytes_.data(), bytes_.size(), RTC_VERSION); }

private:
    std::vector<std::byte> bytes_;
};

// The nearest hits of rays in packets of `width`.
template <unsigned width, typename Packet>
void add_nearest_hits(RTCScene scene, Points& points, Bits& bits) {
    EmbreeQuery query(RayCoherence::incoherent);
    alignas(64) std::array<int, width> valid;
    valid.fill(-1);
    for (unsigned first = 0; first < rays_of_a_kind; first += width) {
        Packet packet;
        RTCRayN* rays = RTCRayHitN_RayN(reinterpret_cast<RTCRayHitN*>(&packet), width);
        RTCHitN* hits = RTCRayHitN_HitN(reinterpret_cast<RTCRayHitN*>(&packet), width);
        for (unsigned i = 0; i < width; ++i) {
            set_ray(rays, width, i, points);
            RTCHitN_geomID(hits, width, i) = RTCHitN_primID(hits, width, i) = RTC_INVALID_GEOMETRY_ID;
            RTCHitN_instID(hits, width, i, 0) = RTC_INVALID_GEOMETRY_ID;
            RTCHitN_u(hits, width, i) = RTCHitN_v(hits, width, i) = 0.0f;
        }
        if constexpr (width == 1) {
            query.intersect(scene, packet);
        } else {
            query.intersect(scene, valid.data(), packet);
        }
        for (unsigned i = 0; i < width; ++i) {
            bits.add(RTCHitN_geomID(hits, width, i)), bits.add(RTCHitN_primID(hits, width, i));
            bits.add(RTCHitN_u(hits, width, i)), bits.add(RTCHitN_v(hits, width, i));
            bits.add(RTCRayN_tfar(rays, width, i));
        }
    }
}

// Whether anything blocks rays in packets of sixteen.
void add_occlusions(RTCScene scene, Points& points, Bits& bits) {
    constexpr unsigned width = 16;
    EmbreeQuery query(RayCoherence::incoherent);
    alignas(64) std::array<int, width> valid;
    valid.fill(-1);
    for (unsigned first = 0; first < rays_of_a_kind; first += width) {
        RTCRay16 packet;
        for (unsigned i = 0; i < width; ++i) set_ray(reinterpret_cast<RTCRayN*>(&packet), width, i, points);
        query.occluded(scene, valid.data(), packet);
        bits.add(packet.tfar);
    }
}

// Those that places, turns, lenses and tables are computed with.
template <typename Number>
void add_function_values(Points& points, Bits& bits) {
    for (int i = 0; i < function_values; ++i) {
        const glm::vec3 point = points.next();
        const auto x = static_cast<Number>(point.x), y = static_cast<Number>(point.y);
        const Number angle = Number(8) * (x - Number(0.5));
        for (const Number value : {std::sin(angle), std::cos(angle), std::tan(x), std::atan2(angle, y), std::exp(angle),
                                   std::log(x + Number(0.001))})
            bits.add(value);
    }
}

}  // namespace

std::uint64_t embree_fingerprint(RTCDevice device) {
    Points points;
    const RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // as TracedScene
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    attach_triangles(device, scene, 1, points);
    attach_triangles(device, scene, 3, points);
    rtcCommitScene(scene);
    Bits bits;
    add_nearest_hits<1, RTCRayHit>(scene, points, bits);
    add_nearest_hits<8, RTCRayHit8>(scene, points, bits);
    add_occlusions(scene, points, bits);
    rtcReleaseScene(scene);
    add_function_values<float>(points, bits);
    add_function_values<double>(points, bits);
    return bits.hash();
}

}  // namespace plumb

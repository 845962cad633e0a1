#include "pathtracer/embree_fingerprint.h"

#include <array>
#include <vector>

#include <glm/glm.hpp>
#include <xxhash.h>

#include "pathtracer/sample_sequence.h"
#include "pathtracer/surface_hit.h"

namespace plumb {
namespace {

constexpr unsigned fingerprint_triangles = 64;
constexpr int fingerprint_rays = 4096;

// Points in the unit cube, always the same.
class Points {
public:
    glm::vec3 next() { return {number(), number(), number()}; }

private:
    float number() { return static_cast<float>(mix_bits(++count_) >> 40) * 0x1p-24f; }

    std::uint64_t count_ = 0;
};

}  // namespace

std::uint64_t embree_fingerprint(RTCDevice device) {
    Points points;
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corners = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 3 * fingerprint_triangles));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), fingerprint_triangles));
    for (unsigned i = 0; i < 3 * fingerprint_triangles; ++i) corners[i] = points.next(), indices[i] = i;
    rtcCommitGeometry(geometry);
    const RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // as TracedScene
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);

    struct Found {
        unsigned triangle;
        float u, v, distance;
    };
    std::vector<Found> found;
    EmbreeQuery query(RayCoherence::incoherent);
    for (int i = 0; i < fingerprint_rays; ++i) {
        const glm::vec3 origin = points.next(), direction = points.next() - origin;
        RTCRayHit ray;
        ray.ray.org_x = origin.x, ray.ray.org_y = origin.y, ray.ray.org_z = origin.z;
        ray.ray.dir_x = direction.x, ray.ray.dir_y = direction.y, ray.ray.dir_z = direction.z;
        ray.ray.tnear = positive_distance, ray.ray.tfar = infinite_distance;
        ray.ray.time = 0.0f, ray.ray.mask = 0xffffffffu, ray.ray.id = 0, ray.ray.flags = 0;
        ray.hit.geomID = ray.hit.primID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        ray.hit.u = ray.hit.v = 0.0f;
        query.intersect(scene, ray);
        found.push_back({ray.hit.primID, ray.hit.u, ray.hit.v, ray.ray.tfar});
    }
    rtcReleaseScene(scene);
    return XXH3_64bits_withSeed(found.data(), found.size() * sizeof(Found), RTC_VERSION);
}

}  // namespace plumb

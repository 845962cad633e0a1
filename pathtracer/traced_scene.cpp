#include "pathtracer/traced_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "pathtracer/oracle_layers.h"
#include "pathtracer/ray_recorder.h"

namespace plumb {
namespace {

// What Embree reads of every ray but never changes.
template <int width, typename Packet>
void set_constants(Packet& packet) {
    for (int i = 0; i < width; ++i) packet.mask[i] = 0xffffffffu, packet.id[i] = 0, packet.flags[i] = 0;
}

// Rays `first` and following into a packet; lanes beyond the last ray are not valid.
template <int width, typename Packet>
void copy_rays(const RayBatch& rays, int first, Packet& packet, std::array<int, width>& valid) {
    const auto copy = [first](float* to, const Lanes<float>& from) {
        std::memcpy(to, &from[first], width * sizeof(float));
    };
    copy(packet.org_x, rays.origin.x), copy(packet.org_y, rays.origin.y), copy(packet.org_z, rays.origin.z);
    copy(packet.dir_x, rays.direction.x), copy(packet.dir_y, rays.direction.y), copy(packet.dir_z, rays.direction.z);
    copy(packet.tnear, rays.nearest), copy(packet.tfar, rays.farthest), copy(packet.time, rays.time);
    for (int i = 0; i < width; ++i) valid[i] = first + i < rays.count ? -1 : 0;
    // Where a processor has no packets as wide, Embree goes by the rays' intervals in the place of `valid`.
    for (int i = std::max(0, rays.count - first); i < width; ++i) {
        packet.tnear[i] = infinite_distance, packet.tfar[i] = -infinite_distance;
    }
}

}  // namespace

void TracedScene::reject_holes(const RTCFilterFunctionNArguments* arguments) {
    const auto& part = *static_cast<const Part*>(arguments->geometryUserPtr);
    const unsigned count = arguments->N;
    for (unsigned i = 0; i < count; ++i) {
        if (arguments->valid[i] != -1) continue;
        const glm::vec2 uv = part.uv(RTCHitN_primID(arguments->hit, count, i), RTCHitN_u(arguments->hit, count, i),
                                     RTCHitN_v(arguments->hit, count, i));
        if (!part.is_opaque(uv)) arguments->valid[i] = 0;
    }
}

void TracedScene::reject_what_layers_lack(const RTCFilterFunctionNArguments* arguments) {
    const auto& layers = *static_cast<const OracleLayers*>(EmbreeQuery::user_of(arguments));
    const unsigned count = arguments->N;
    RTCRayN* rays = arguments->ray;
    for (unsigned i = 0; i < count; ++i) {
        if (arguments->valid[i] != -1) continue;
        const float distance = RTCRayN_tfar(rays, count, i);
        const glm::vec3 point(RTCRayN_org_x(rays, count, i) + distance * RTCRayN_dir_x(rays, count, i),
                              RTCRayN_org_y(rays, count, i) + distance * RTCRayN_dir_y(rays, count, i),
                              RTCRayN_org_z(rays, count, i) + distance * RTCRayN_dir_z(rays, count, i));
        if (!layers.contain(point)) arguments->valid[i] = 0;
    }
}

EmbreeQuery TracedScene::query_for(const OracleLayers* layers, RayCoherence coherence) {
    return EmbreeQuery(coherence, layers ? &TracedScene::reject_what_layers_lack : nullptr, layers);
}

SurfaceHit TracedScene::intersect(EmbreeQuery& query, RTCScene scene, const glm::vec3& origin,
                                  const glm::vec3& direction, float nearest, float farthest, float time) {
    RTCRayHit ray;
    ray.ray.org_x = origin.x, ray.ray.org_y = origin.y, ray.ray.org_z = origin.z;
    ray.ray.dir_x = direction.x, ray.ray.dir_y = direction.y, ray.ray.dir_z = direction.z;
    ray.ray.tnear = nearest, ray.ray.tfar = farthest;
    ray.ray.time = time, ray.ray.mask = 0xffffffffu, ray.ray.id = 0, ray.ray.flags = 0;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query.intersect(scene, ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {ray.hit.geomID, ray.hit.primID, ray.hit.u, ray.hit.v, ray.ray.tfar};
}

SurfaceHit TracedScene::intersect(const glm::vec3& origin, const glm::vec3& direction, float nearest, float farthest,
                                  RayCoherence coherence, float time, const OracleLayers* layers) const {
    EmbreeQuery query = query_for(layers, coherence);
    return intersect(query, scene_for(layers), origin, direction, nearest, farthest, time);
}

void TracedScene::intersect(const RayBatch& rays, HitBatch& hits, const OracleLayers* layers) const {
    if (recorder_) recorder_->add_nearest(rays);
    // Never as coherent rays: those share a path through the tree, and which of two coincident triangles one meets
    // depends on the others.
    EmbreeQuery query = query_for(layers);
    const RTCScene scene = scene_for(layers);
    // Eight rays together find the very hits that each finds alone, some tenth sooner (benchmark `packets`).
    constexpr int width = 8;
    RTCRayHit8 packet;
    set_constants<width>(packet.ray);
    for (int first = 0; first < rays.count; first += width) {
        alignas(32) std::array<int, width> valid;
        copy_rays<width>(rays, first, packet.ray, valid);
        std::fill_n(packet.hit.geomID, width, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(packet.hit.instID[0], width, RTC_INVALID_GEOMETRY_ID);
        query.intersect(scene, valid.data(), packet);
        static_assert(RTC_INVALID_GEOMETRY_ID == SurfaceHit::nothing && most_lanes % width == 0);
        std::copy_n(packet.hit.geomID, width, &hits.instance[first]);
        std::copy_n(packet.hit.primID, width, &hits.triangle[first]);
        std::copy_n(packet.hit.u, width, &hits.u[first]), std::copy_n(packet.hit.v, width, &hits.v[first]);
        std::copy_n(packet.ray.tfar, width, &hits.distance[first]);
    }
}

void TracedScene::occluded(const RayBatch& rays, Lanes<int>& blocked, const OracleLayers* layers) const {
    if (recorder_) recorder_->add_any(rays);
    EmbreeQuery query = query_for(layers);
    const RTCScene scene = scene_for(layers);
    constexpr int width = 16;
    RTCRay16 packet;
    set_constants<width>(packet);
    for (int first = 0; first < rays.count; first += width) {
        alignas(64) std::array<int, width> valid;
        copy_rays<width>(rays, first, packet, valid);
        query.occluded(scene, valid.data(), packet);
        // Embree sets minus infinity where something is in the way.
        for (int i = 0; i < width; ++i) blocked[first + i] = packet.tfar[i] < 0.0f ? 1 : 0;
    }
}

void TracedScene::transmittance(const RayBatch& rays, VectorLanes& fraction) const {
    if (!has_transparency_) {
        Lanes<int> blocked;
        occluded(rays, blocked);
        for (int i = 0; i < whole_groups(rays.count); ++i) fraction.set(i, glm::vec3(blocked[i] ? 0.0f : 1.0f));
        return;
    }
    EmbreeQuery query(RayCoherence::incoherent);
    for (int i = 0; i < rays.count; ++i) {
        const glm::vec3 origin = rays.origin.get(i), direction = rays.direction.get(i);
        glm::vec3 passing(1.0f);
        float from = rays.nearest[i];
        while (passing != glm::vec3(0.0f)) {
            const SurfaceHit hit =
                intersect(query, embree_scene_, origin, direction, from, rays.farthest[i], rays.time[i]);
            if (hit.missed()) break;
            if (is_plain(hit.instance)) {
                passing = glm::vec3(0.0f);
                break;
            }
            const SurfacePoint pane = surface_point(hit, direction, rays.time[i]);
            const glm::vec3 to_viewer = -glm::normalize(direction);
            passing *=
                pane.specular.transmission * (1.0f - specular_albedo(pane.specular, pane.shading_normal, to_viewer));
            from = std::nextafter(hit.distance, infinite_distance);
        }
        fraction.set(i, passing);
    }
}

}  // namespace plumb

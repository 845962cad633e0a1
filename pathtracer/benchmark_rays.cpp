#include "pathtracer/benchmark_rays.h"

#include <algorithm>
#include <array>

#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>

namespace plumb {
namespace {

// Calls `trace` with ranges of rays on all threads.
template <typename Trace>
void in_chunks(std::size_t count, const Trace& trace) {
    constexpr std::size_t chunk = 4096;
    tbb::parallel_for(std::size_t{0}, (count + chunk - 1) / chunk,
                      [&](std::size_t i) { trace(i * chunk, std::min(count, (i + 1) * chunk)); });
}

RTCRay single_ray(const RecordedRay& from) {
    RTCRay ray;
    ray.org_x = from.origin.x, ray.org_y = from.origin.y, ray.org_z = from.origin.z, ray.tnear = from.nearest;
    ray.dir_x = from.direction.x, ray.dir_y = from.direction.y, ray.dir_z = from.direction.z, ray.time = now;
    ray.tfar = from.farthest, ray.mask = 0xffffffffu, ray.id = 0, ray.flags = 0;
    return ray;
}

RTCRayHit single_ray_hit(const RecordedRay& from) {
    RTCRayHit ray{single_ray(from), {}};
    ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return ray;
}

void nearest_singly(RTCScene scene, const std::vector<RecordedRay>& rays, RayCoherence coherence) {
    in_chunks(rays.size(), [&](std::size_t begin, std::size_t end) {
        EmbreeQuery query(coherence);
        for (std::size_t i = begin; i < end; ++i) {
            RTCRayHit ray = single_ray_hit(rays[i]);
            query.intersect(scene, ray);
            benchmark::DoNotOptimize(ray);
        }
    });
}

void any_singly(RTCScene scene, const std::vector<RecordedRay>& rays, RayCoherence coherence) {
    in_chunks(rays.size(), [&](std::size_t begin, std::size_t end) {
        EmbreeQuery query(coherence);
        for (std::size_t i = begin; i < end; ++i) {
            RTCRay ray = single_ray(rays[i]);
            query.occluded(scene, ray);
            benchmark::DoNotOptimize(ray);
        }
    });
}

// Fills a packet with the rays from `first` on; lanes past the last one are told to be idle.
template <int width, typename Packet>
void fill(Packet& packet, int* valid, const std::vector<RecordedRay>& rays, std::size_t first, std::size_t end) {
    for (int i = 0; i < width; ++i) {
        const std::size_t index = first + static_cast<std::size_t>(i);
        const RecordedRay& from = rays[std::min(end - 1, index)];
        valid[i] = index < end ? -1 : 0;
        packet.org_x[i] = from.origin.x, packet.org_y[i] = from.origin.y, packet.org_z[i] = from.origin.z;
        packet.dir_x[i] = from.direction.x, packet.dir_y[i] = from.direction.y, packet.dir_z[i] = from.direction.z;
        packet.tnear[i] = from.nearest, packet.tfar[i] = from.farthest, packet.time[i] = now;
        packet.mask[i] = 0xffffffffu, packet.id[i] = 0, packet.flags[i] = 0;
    }
}

template <int width, typename Packet>
void nearest_by_packets(RTCScene scene, const std::vector<RecordedRay>& rays, RayCoherence coherence) {
    in_chunks(rays.size(), [&](std::size_t begin, std::size_t end) {
        EmbreeQuery query(coherence);
        for (std::size_t first = begin; first < end; first += width) {
            alignas(64) std::array<int, width> valid;
            Packet packet;
            fill<width>(packet.ray, valid.data(), rays, first, end);
            std::fill_n(packet.hit.geomID, width, RTC_INVALID_GEOMETRY_ID);
            std::fill_n(packet.hit.instID[0], width, RTC_INVALID_GEOMETRY_ID);
            query.intersect(scene, valid.data(), packet);
            benchmark::DoNotOptimize(packet);
        }
    });
}

template <int width, typename Packet>
void any_by_packets(RTCScene scene, const std::vector<RecordedRay>& rays, RayCoherence coherence) {
    in_chunks(rays.size(), [&](std::size_t begin, std::size_t end) {
        EmbreeQuery query(coherence);
        for (std::size_t first = begin; first < end; first += width) {
            alignas(64) std::array<int, width> valid;
            Packet packet;
            fill<width>(packet, valid.data(), rays, first, end);
            query.occluded(scene, valid.data(), packet);
            benchmark::DoNotOptimize(packet);
        }
    });
}

#if RTC_VERSION_MAJOR < 4
// As many rays at once as the path tracer follows paths.
constexpr std::size_t stream_length = most_lanes;

void nearest_by_streams(RTCScene scene, const std::vector<RecordedRay>& rays, RayCoherence coherence) {
    in_chunks(rays.size(), [&](std::size_t begin, std::size_t end) {
        EmbreeQuery query(coherence);
        for (std::size_t first = begin; first < end; first += stream_length) {
            std::array<RTCRayHit, stream_length> stream;
            const std::size_t count = std::min(stream_length, end - first);
            for (std::size_t i = 0; i < count; ++i) stream[i] = single_ray_hit(rays[first + i]);
            query.intersect(scene, std::span(stream).first(count));
            benchmark::DoNotOptimize(stream);
        }
    });
}

void any_by_streams(RTCScene scene, const std::vector<RecordedRay>& rays, RayCoherence coherence) {
    in_chunks(rays.size(), [&](std::size_t begin, std::size_t end) {
        EmbreeQuery query(coherence);
        for (std::size_t first = begin; first < end; first += stream_length) {
            std::array<RTCRay, stream_length> stream;
            const std::size_t count = std::min(stream_length, end - first);
            for (std::size_t i = 0; i < count; ++i) stream[i] = single_ray(rays[first + i]);
            query.occluded(scene, std::span(stream).first(count));
            benchmark::DoNotOptimize(stream);
        }
    });
}
#endif

}  // namespace

const WayToTrace singly{"singly", nearest_singly, any_singly};
const WayToTrace by_sixteen{"by 16", nearest_by_packets<16, RTCRayHit16>, any_by_packets<16, RTCRay16>};

std::span<const WayToTrace> ways_to_trace() {
    static const std::array ways = {
        singly,
        WayToTrace{"by 4", nearest_by_packets<4, RTCRayHit4>, any_by_packets<4, RTCRay4>},
        WayToTrace{"by 8", nearest_by_packets<8, RTCRayHit8>, any_by_packets<8, RTCRay8>},
        by_sixteen,
#if RTC_VERSION_MAJOR < 4
        WayToTrace{"streams", nearest_by_streams, any_by_streams},
#endif
    };
    return ways;
}

}  // namespace plumb

// Paths that are followed side by side: where they stand, and what they have found.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <glm/glm.hpp>

#include "pathtracer/light_sample.h"
#include "pathtracer/ray_batch.h"
#include "pathtracer/sample_sequence.h"
#include "scenes/ggx.h"

namespace plumb {

// A vertex of a path whose surface is not plainly Lambertian.
struct SpecularVertex {
    SpecularSurface surface;
    glm::vec3 to_viewer{0.0f};  // unit, back along the path
    glm::vec3 far_side{0.0f};   // where a ray that passes straight through starts
};

// The vertices at which `count` paths stand. The albedo is that of the diffuse lobe, less what the specular one takes.
struct VertexBatch : SurfaceLanes {
    int count = 0;
    Lanes<int> path;  // which path of the batch stands here
    SampleLanes samples;
    Lanes<float> time;
    VectorLanes throughput;  // of the path up to here
    Lanes<std::uint8_t> is_plain;
    bool all_plain = true;
    bool each_its_path = false;                       // lane i is path i
    std::array<SpecularVertex, most_lanes> specular;  // for lanes that are not plain

    void clear() {
        count = 0;
        all_plain = true;
        each_its_path = false;
    }

    // Makes lane `to` what lane `from` of `other` is, but for its specular side.
    void set(int to, const VertexBatch& other, int from) {
        path[to] = other.path[from];
        samples.set(to, other.samples.get(from));
        time[to] = other.time[from];
        ray_origin.set(to, other.ray_origin.get(from));
        geometric_normal.set(to, other.geometric_normal.get(from));
        shading_normal.set(to, other.shading_normal.get(from));
        bulge[to] = other.bulge[from];
        albedo.set(to, other.albedo.get(from));
        throughput.set(to, other.throughput.get(from));
    }

    LightReceiver receiver(int lane) const {
        const glm::vec3 normal = shading_normal.get(lane);
        return {ray_origin.get(lane),
                normal,
                is_plain[lane] ? normal : lobe_normal(normal, specular[lane].to_viewer),
                geometric_normal.get(lane),
                bulge[lane],
                time[lane]};
    }

    // Takes over lane `from` of `other`.
    void add(const VertexBatch& other, int from) {
        set(count, other, from);
        is_plain[count] = other.is_plain[from];
        all_plain &= is_plain[count] != 0;
        if (!is_plain[count]) specular[count] = other.specular[from];
        ++count;
    }

    // Gives lanes begin + 1 to end - 1 the vertex of lane `begin`, as paths and with samples of their own.
    void repeat(int begin, int end) {
        for (int lane = begin; lane < end; ++lane) path[lane] = lane;
        time.fill(begin, end, time[begin]);
        ray_origin.fill(begin, end, ray_origin.get(begin));
        geometric_normal.fill(begin, end, geometric_normal.get(begin));
        shading_normal.fill(begin, end, shading_normal.get(begin));
        bulge.fill(begin, end, bulge[begin]);
        albedo.fill(begin, end, albedo.get(begin));
        throughput.fill(begin, end, throughput.get(begin));
        is_plain.fill(begin, end, is_plain[begin]);
        if (!is_plain[begin]) std::fill(specular.begin() + begin, specular.begin() + end, specular[begin]);
        count = end;
    }
};

// What each path of a batch found, by path.
struct BatchEstimate {
    Lanes<float> ambient_visibility;
    // By vertex, as many as the plan has; as if x's albedo were 1, but over pi.
    std::vector<VectorLanes> radiance;
    VectorLanes reflection;
    int rays = 0;
};

// The rays with which paths leave their vertices, one beside the other.
struct ScatteredRays {
    RayBatch rays;
    Lanes<int> vertex;     // lane of the vertex that each leaves
    VectorLanes weight;    // BSDF times cosine over density
    Lanes<float> density;  // per solid angle; 0: nothing else finds this direction
    // From a bulge, where the ray passes the plane of the face: what lies before it the face itself sees. Else 0.
    Lanes<float> face_plane;
    Lanes<int> ended;  // lanes whose direction led into their own surface
    int ended_count = 0;
    bool all_leave = false;  // every vertex's ray is in its own lane

    void clear() {
        rays.count = ended_count = 0;
        all_leave = false;
    }
    // Makes what stands in lane `from` the next ray, which is never behind that lane.
    void keep(int from, const glm::vec3& origin, float time) {
        const int to = rays.count;
        vertex[to] = from, density[to] = density[from], face_plane[to] = face_plane[from];
        weight.set(to, weight.get(from));
        rays.add(origin, rays.direction.get(from), infinite_distance, time);
    }
};

// Shadow rays, and the lane of the vertex that each leaves.
struct ShadowRays {
    RayBatch rays;
    Lanes<int> vertex;

    void add(int lane, const glm::vec3& origin, const glm::vec3& direction, float reach, float time) {
        vertex[rays.count] = lane;
        rays.add(origin, direction, reach, time);
    }
};

// Room for what is passed from step to step, so that none of it is made anew for every batch.
struct PathWorkspace {
    VertexBatch starts, vertices, next;
    LightLanes lights;
    ScatteredRays scattered;
    ShadowRays shadow, to_bulges;
    HitBatch hits;
    MetRays met;
};

}  // namespace plumb

// Paths that are followed side by side: where they stand, and what they have found.
#pragma once

#include <array>

#include <glm/glm.hpp>

#include "pathtracer/ray_batch.h"
#include "pathtracer/sample_sequence.h"

namespace plumb {

constexpr int most_bounces = 64;

// A vertex of a path whose surface is not plainly Lambertian.
struct SpecularVertex {
    SpecularSurface surface;
    glm::vec3 to_viewer{0.0f};  // unit, back along the path
    glm::vec3 far_side{0.0f};   // where a ray that passes straight through starts
};

// The vertices at which `count` paths stand.
struct VertexBatch {
    int count = 0;
    Lanes<int> path;  // which path of the batch stands here
    SampleLanes samples;
    Lanes<float> time;
    VectorLanes ray_origin, geometric_normal, shading_normal;
    VectorLanes albedo;      // of the diffuse lobe, already less what the specular one takes
    VectorLanes throughput;  // of the path up to here
    Lanes<std::uint8_t> is_plain;
    std::array<SpecularVertex, most_lanes> specular;  // for lanes that are not plain

    void add(const VertexBatch& other, int from) {
        path[count] = other.path[from];
        samples.set(count, other.samples.get(from));
        time[count] = other.time[from];
        ray_origin.set(count, other.ray_origin.get(from));
        geometric_normal.set(count, other.geometric_normal.get(from));
        shading_normal.set(count, other.shading_normal.get(from));
        albedo.set(count, other.albedo.get(from));
        throughput.set(count, other.throughput.get(from));
        is_plain[count] = other.is_plain[from];
        if (!is_plain[count]) specular[count] = other.specular[from];
        ++count;
    }
};

// What each path of a batch found, by path.
struct BatchEstimate {
    Lanes<float> ambient_visibility;
    // By vertex; as if x's albedo were 1, but over pi.
    std::array<VectorLanes, most_bounces + 1> radiance;
    VectorLanes reflection;
    int rays = 0;
};

}  // namespace plumb

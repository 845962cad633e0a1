// What lies where rays hit a TracedScene: geometry and material of one point, or of many side by side.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "pathtracer/traced_scene.h"
#include "scenes/ggx.h"

namespace plumb {
namespace {

// Where between two poses a time lies.
struct MotionStep {
    int first;
    float weight;

    MotionStep(float time, int steps) {
        const float at = std::clamp(time, 0.0f, 1.0f) * static_cast<float>(steps - 1);
        first = std::min(static_cast<int>(at), steps - 2);
        weight = at - static_cast<float>(first);
    }
    glm::vec3 mix(const glm::vec3& from, const glm::vec3& to) const { return (1.0f - weight) * from + weight * to; }
};

struct PointGeometry {
    glm::vec3 position, ray_origin, geometric_normal, shading_normal;
    float bulge;
    float side;  // 1: seen from the front, -1: from the back
};

// Weighted by the corners' weights, how far a point of the triangle lies under the planes through the corners that the
// normals there define, and above them: by how much the surface that the normals tell of bulges to the front and to the
// back.
//   Source: Hanika 2021, "Hacking the Shadow Terminator" (Ray Tracing Gems II, chapter 4), of which this is the length.
struct Bulge {
    float front, back;
};
PLUMBLINE_INLINE Bulge bulge_of(const TracedTriangle& triangle, const std::array<glm::vec3, 3>& normals, float u,
                                float v) {
    const glm::vec3 point = triangle.point(u, v);
    const float a = (1.0f - u - v) * glm::dot(triangle.a - point, normals[0]);
    const float b = u * glm::dot(triangle.b - point, normals[1]), c = v * glm::dot(triangle.c - point, normals[2]);
    const float front = std::max(0.0f, a) + std::max(0.0f, b) + std::max(0.0f, c);
    return {front, front - (a + b + c)};
}

PLUMBLINE_INLINE glm::vec3 interpolate(const std::array<glm::vec3, 3>& corners, float u, float v) {
    return (1.0f - u - v) * corners[0] + u * corners[1] + v * corners[2];
}

// Without branches, for loops over lanes. A zero `normal_sum` (none, or opposite normals that cancel) leaves the
// face's.
PLUMBLINE_INLINE PointGeometry point_geometry(const TracedTriangle& triangle, float u, float v,
                                              const glm::vec3& normal_sum, const Bulge& bulge,
                                              const glm::vec3& ray_direction) {
    PointGeometry point;
    point.position = triangle.point(u, v);
    const glm::vec3 scaled_normal = triangle.scaled_normal();
    const glm::vec3 normal = scaled_normal * (1.0f / std::sqrt(glm::dot(scaled_normal, scaled_normal)));
    const float squared_length = glm::dot(normal_sum, normal_sum);
    const float inverse_length = squared_length > 0.0f ? 1.0f / std::sqrt(squared_length) : 0.0f;
    const glm::vec3 smooth = squared_length > 0.0f ? normal_sum * inverse_length : normal;
    const float side = glm::dot(normal, ray_direction) > 0.0f ? -1.0f : 1.0f;
    point.side = side;
    point.geometric_normal = side * normal;
    point.shading_normal = side * smooth;
    const float step = glm::dot(glm::abs(normal), triangle.error());
    point.ray_origin = point.position + step * point.geometric_normal;
    // Normals that contradict the face tell of no surface. Less than the rounding error is nothing.
    const float height = side > 0.0f ? bulge.front : bulge.back;
    point.bulge = height * glm::dot(smooth, normal) > step ? height : 0.0f;
    return point;
}

SpecularSurface specular_side(const SurfaceSample& sample) {
    return {sample.specular_f0, sample.specular_f90, ggx_alpha(sample.roughness), sample.transmission};
}

}  // namespace

// Inlined where surfaces are looked up by the batch.
PLUMBLINE_INLINE void TracedScene::Part::corners(std::uint32_t triangle, float time, TracedTriangle& corners) const {
    const std::uint32_t* indices = triangles + 3 * static_cast<std::size_t>(triangle);
    if (steps == 1) {
        corners.a = positions[indices[0]], corners.b = positions[indices[1]], corners.c = positions[indices[2]];
        return;
    }
    const MotionStep at(time, steps);
    const glm::vec3* first = positions + static_cast<std::size_t>(at.first) * vertex_count;
    const auto moved = [&](std::uint32_t vertex) { return at.mix(first[vertex], first[vertex_count + vertex]); };
    corners.a = moved(indices[0]), corners.b = moved(indices[1]), corners.c = moved(indices[2]);
}

std::array<glm::vec3, 3> TracedScene::Part::corner_normals(std::uint32_t triangle, float time) const {
    const std::uint32_t* indices = triangles + 3 * static_cast<std::size_t>(triangle);
    if (steps == 1) return {normals[indices[0]], normals[indices[1]], normals[indices[2]]};
    const MotionStep at(time, steps);
    const glm::vec3* first = normals + static_cast<std::size_t>(at.first) * vertex_count;
    const auto moved = [&](std::uint32_t vertex) { return at.mix(first[vertex], first[vertex_count + vertex]); };
    return {moved(indices[0]), moved(indices[1]), moved(indices[2])};
}

SurfaceSample TracedScene::Part::sample(const glm::vec2& uv) const {
    if (!has_textures) return constant;
    return sample_surface(*material, [&](int texture) { return textures->sample(texture, uv); });
}

bool TracedScene::Part::is_opaque(const glm::vec2& uv) const {
    return is_surface_opaque(*material, [&](int texture) { return textures->sample(texture, uv); });
}

SurfacePoint TracedScene::surface_point(const SurfaceHit& hit, const glm::vec3& ray_direction, float time) const {
    const Part& part = parts_[hit.instance];
    TracedTriangle corners;
    part.corners(hit.triangle, time, corners);
    const std::array<glm::vec3, 3> normals = part.corner_normals(hit.triangle, time);
    const Bulge bulge = anything_bulges_ ? bulge_of(corners, normals, hit.u, hit.v) : Bulge{0.0f, 0.0f};
    const PointGeometry geometry =
        point_geometry(corners, hit.u, hit.v, interpolate(normals, hit.u, hit.v), bulge, ray_direction);
    SurfacePoint point;
    point.position = geometry.position;
    point.ray_origin = geometry.ray_origin;
    point.geometric_normal = geometry.geometric_normal;
    point.shading_normal = geometry.shading_normal;
    point.bulge = geometry.bulge;
    if (geometry.side > 0.0f || part.material->two_sided) {
        const SurfaceSample sample = part.sample(part.uv(hit.triangle, hit.u, hit.v));
        point.albedo = sample.albedo, point.emission = sample.emission;
        if (!part.is_plain) point.specular = specular_side(sample);
    }
    return point;
}

// The corners of triangles that were hit, and what is interpolated between them.
struct CornerLanes {
    VectorLanes a, b, c, normal_sum;
    Lanes<float> bulge_front, bulge_back;
    Lanes<float> texture_u, texture_v;  // where the scene has textures
};

// Where nothing moves. Two rounds: the first starts to fetch the triangles, for hardly any of them is in a nearby
// cache. One by one: a record lies in two cache lines, from which single loads take less time than gathers.
void TracedScene::gather_corners(const HitBatch& hits, const MetRays& met, CornerLanes& corners) const {
    constexpr int floats = sizeof(TriangleRecord) / sizeof(float);
    const int* first_triangle = table_.first_triangle.data();
    const float* records = &records_.data()->positions[0].x;
    const int end = whole_groups(met.count);
    Lanes<int> record;
    for (int i = 0; i < end; ++i) {
        const int ray = met.ray[i];
        record[i] = floats * (first_triangle[hits.instance[ray]] + static_cast<int>(hits.triangle[ray]));
        __builtin_prefetch(records + record[i]), __builtin_prefetch(records + record[i] + floats - 1);
    }
    const auto vector = [](const float* from) { return glm::vec3(from[0], from[1], from[2]); };
    for (int i = 0; i < end; ++i) {
        const float* from = records + record[i];
        corners.a.set(i, vector(from)), corners.b.set(i, vector(from + 3)), corners.c.set(i, vector(from + 6));
    }
    const auto normals = [&](int i) {
        const float* from = records + record[i] + 9;
        return std::array<glm::vec3, 3>{vector(from), vector(from + 3), vector(from + 6)};
    };
    if (!has_normals_) corners.normal_sum.fill(0, met.count, glm::vec3(0.0f));
    for (int i = 0; i < end && has_normals_; ++i) {
        corners.normal_sum.set(i, interpolate(normals(i), hits.u[met.ray[i]], hits.v[met.ray[i]]));
    }
    if (!anything_bulges_) corners.bulge_front.fill(0, met.count, 0.0f), corners.bulge_back.fill(0, met.count, 0.0f);
    for (int i = 0; i < end && anything_bulges_; ++i) {
        const TracedTriangle triangle{corners.a.get(i), corners.b.get(i), corners.c.get(i), {}, {}, {}};
        const Bulge bulge = bulge_of(triangle, normals(i), hits.u[met.ray[i]], hits.v[met.ray[i]]);
        corners.bulge_front[i] = bulge.front, corners.bulge_back[i] = bulge.back;
    }
    for (int i = 0; i < end && has_textures_; ++i) {
        const float u = hits.u[met.ray[i]], v = hits.v[met.ray[i]], w = 1.0f - u - v;
        const float* from = records + record[i] + 18;
        corners.texture_u[i] = w * from[0] + u * from[2] + v * from[4];
        corners.texture_v[i] = w * from[1] + u * from[3] + v * from[5];
    }
}

void TracedScene::gather_moving_corners(const RayBatch& rays, const HitBatch& hits, const MetRays& met,
                                        CornerLanes& corners) const {
    for (int i = 0; i < whole_groups(met.count); ++i) {
        const int ray = met.ray[i];
        const SurfaceHit hit = hits.get(ray);
        const Part& part = parts_[hit.instance];
        TracedTriangle triangle;
        part.corners(hit.triangle, rays.time[ray], triangle);
        corners.a.set(i, triangle.a), corners.b.set(i, triangle.b), corners.c.set(i, triangle.c);
        const std::array<glm::vec3, 3> normals = part.corner_normals(hit.triangle, rays.time[ray]);
        corners.normal_sum.set(i, interpolate(normals, hit.u, hit.v));
        const Bulge bulge = bulge_of(triangle, normals, hit.u, hit.v);
        corners.bulge_front[i] = bulge.front, corners.bulge_back[i] = bulge.back;
        const glm::vec2 uv = part.uv(hit.triangle, hit.u, hit.v);
        corners.texture_u[i] = uv.x, corners.texture_v[i] = uv.y;
    }
}

void TracedScene::look_up_textures(const HitBatch& hits, const MetRays& met, const CornerLanes& corners,
                                   const Lanes<float>& lit, SurfaceLanes& points) const {
    const auto look_up = [&](int Material::*texture, VectorLanes& values) {
        Lanes<int> textures;
        for (int i = 0; i < met.count; ++i) textures[i] = parts_[hits.instance[met.ray[i]]].material->*texture;
        textures_.sample(textures, corners.texture_u, corners.texture_v, met.count, values);
    };
    VectorLanes base_colour, metallic_roughness, emission;
    look_up(&Material::base_colour_texture, base_colour);
    look_up(&Material::metallic_roughness_texture, metallic_roughness);
    look_up(&Material::emission_texture, emission);
    for (int i = 0; i < met.count; ++i) {
        const Part& part = parts_[hits.instance[met.ray[i]]];
        if (!part.has_textures) continue;
        const Material& material = *part.material;
        const SurfaceSample sample = sample_surface(material, [&](int texture) {
            const VectorLanes& values = texture == material.base_colour_texture          ? base_colour
                                        : texture == material.metallic_roughness_texture ? metallic_roughness
                                                                                         : emission;
            return glm::vec4(values.get(i), 1.0f);
        });
        points.albedo.set(i, lit[i] * sample.albedo), points.emission.set(i, lit[i] * sample.emission);
    }
}

void TracedScene::surface_points(const RayBatch& rays, const HitBatch& hits, const MetRays& met,
                                 SurfaceLanes& points) const {
    CornerLanes corners;
    if (anything_moves_) {
        gather_moving_corners(rays, hits, met, corners);
    } else {
        gather_corners(hits, met, corners);
    }
    Lanes<float> lit;
    const float *back_is_lit = table_.back_is_lit.data(), *albedos = &table_.albedo.data()->x,
                *emissions = &table_.emission.data()->x;
    PLUMBLINE_INDEPENDENT_LANES
    for (int i = 0; i < whole_groups(met.count); ++i) {
        const int ray = met.ray[i];
        const PointGeometry point = point_geometry(
            {corners.a.get(i), corners.b.get(i), corners.c.get(i), {}, {}, {}}, hits.u[ray], hits.v[ray],
            corners.normal_sum.get(i), {corners.bulge_front[i], corners.bulge_back[i]}, rays.direction.get(ray));
        points.ray_origin.set(i, point.ray_origin);
        points.geometric_normal.set(i, point.geometric_normal);
        points.shading_normal.set(i, point.shading_normal);
        points.bulge[i] = point.bulge;
        const auto instance = static_cast<int>(hits.instance[ray]);
        const float lit_from_behind = back_is_lit[instance];
        lit[i] = point.side > 0.0f ? 1.0f : lit_from_behind;
        const auto at = [first = 3 * instance](const float* from) {
            return glm::vec3(from[first], from[first + 1], from[first + 2]);
        };
        points.albedo.set(i, lit[i] * at(albedos));
        points.emission.set(i, lit[i] * at(emissions));
    }
    if (has_textures_) look_up_textures(hits, met, corners, lit, points);
}

glm::vec3 TracedScene::specular_albedo(const SpecularSurface& surface, const glm::vec3& shading_normal,
                                       const glm::vec3& to_viewer) const {
    if (!surface.has_lobe()) return glm::vec3(0.0f);
    const float cosine = std::max(0.0f, glm::dot(lobe_normal(shading_normal, to_viewer), to_viewer));
    return specular_albedo_->albedo(surface.f0, surface.f90, cosine, surface.alpha);
}

TracedTriangle TracedScene::triangle(std::uint32_t instance, std::uint32_t index, float time) const {
    const Part& part = parts_[instance];
    TracedTriangle triangle;
    part.corners(index, time, triangle);
    if (part.uvs) {
        const std::uint32_t* corners = part.triangles + 3 * static_cast<std::size_t>(index);
        triangle.uv_a = (*part.uvs)[corners[0]], triangle.uv_b = (*part.uvs)[corners[1]],
        triangle.uv_c = (*part.uvs)[corners[2]];
    }
    return triangle;
}

}  // namespace plumb

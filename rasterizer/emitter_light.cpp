#include "rasterizer/emitter_light.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

namespace plumb {
namespace {

struct EmissiveTriangle {
    glm::vec3 a, b, c;  // world space, counter-clockwise seen from the front
    glm::vec3 radiance;
    glm::vec3 vector_area;

    glm::vec3 centre() const { return (a + b + c) / 3.0f; }
    float area() const { return glm::length(vector_area); }
    float power() const { return area() * (radiance.x + radiance.y + radiance.z); }
};

glm::vec3 mean_radiance(const Scene& scene, const Material& material, const Mesh& mesh, const glm::uvec3& triangle) {
    if (material.emission_texture == no_texture || mesh.uvs.empty()) return scene.surface(material, {}).emission;
    // Centres of the 64 congruent triangles that three halvings of the sides make.
    constexpr int divisions = 8;
    glm::vec3 sum(0.0f);
    const auto add = [&](float u, float v) {
        const glm::vec2 uv =
            (1.0f - u - v) * mesh.uvs[triangle.x] + u * mesh.uvs[triangle.y] + v * mesh.uvs[triangle.z];
        sum += scene.surface(material, uv).emission;
    };
    for (int i = 0; i < divisions; ++i) {
        for (int j = 0; i + j < divisions; ++j) {
            const auto x = static_cast<float>(i), y = static_cast<float>(j);
            add((x + 1.0f / 3.0f) / divisions, (y + 1.0f / 3.0f) / divisions);
            if (i + j + 1 < divisions) add((x + 2.0f / 3.0f) / divisions, (y + 2.0f / 3.0f) / divisions);
        }
    }
    return sum / static_cast<float>(divisions * divisions);
}

std::vector<EmissiveTriangle> emissive_triangles(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const Material& material = scene.materials[mesh.material];
    const bool mirrored = glm::determinant(glm::mat3(instance.world_from_object)) < 0.0f;
    std::vector<EmissiveTriangle> triangles;
    for (const glm::uvec3& corners : mesh.triangles) {
        const auto world = [&](unsigned i) {
            return glm::vec3(instance.world_from_object * glm::vec4(mesh.positions[i], 1.0f));
        };
        EmissiveTriangle triangle{world(corners.x), world(corners.y), world(corners.z), {}, {}};
        if (mirrored) std::swap(triangle.b, triangle.c);
        triangle.radiance = mean_radiance(scene, material, mesh, corners);
        triangle.vector_area = 0.5f * glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
        if (triangle.power() > 0.0f) triangles.push_back(triangle);
    }
    return triangles;
}

// Every edge is walked once each way. Corners at the same place count as one: meshes repeat them at creases.
bool is_closed(const std::vector<EmissiveTriangle>& triangles) {
    const auto key = [](const glm::vec3& p) { return std::tuple(p.x, p.y, p.z); };
    using Point = std::tuple<float, float, float>;
    std::map<std::pair<Point, Point>, int> balance;
    for (const EmissiveTriangle& t : triangles) {
        const glm::vec3 corners[3] = {t.a, t.b, t.c};
        for (int i = 0; i < 3; ++i) {
            const Point from = key(corners[i]), to = key(corners[(i + 1) % 3]);
            if (from < to) {
                ++balance[{from, to}];
            } else {
                --balance[{to, from}];
            }
        }
    }
    return std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; });
}

EmitterPiece piece(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& radiance) {
    return {a, radiance.x, b, radiance.y, c, radiance.z};
}

// Position along a Morton curve of 10 bits per axis through the box.
std::uint32_t morton_code(const glm::vec3& point, const Bounds& box) {
    const glm::vec3 extent = glm::max(box.upper - box.lower, glm::vec3(1e-20f));
    const glm::uvec3 cell(glm::clamp((point - box.lower) / extent, 0.0f, 1.0f) * 1023.0f);
    std::uint32_t code = 0;
    for (int bit = 9; bit >= 0; --bit) {
        for (int axis = 0; axis < 3; ++axis) code = code << 1 | (cell[axis] >> bit & 1u);
    }
    return code;
}

// 0 to 5: the axis that the triangle faces most.
int facing_axis(const EmissiveTriangle& triangle) {
    const glm::vec3 size = glm::abs(triangle.vector_area);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return 2 * axis + (triangle.vector_area[axis] < 0.0f ? 1 : 0);
}

std::vector<EmitterPiece> cluster(std::vector<EmissiveTriangle> triangles) {
    Bounds box;
    float total_power = 0.0f;
    for (const EmissiveTriangle& triangle : triangles) box.add(triangle.centre()), total_power += triangle.power();
    std::ranges::stable_sort(triangles, {}, [&](const EmissiveTriangle& triangle) {
        return std::pair(facing_axis(triangle), morton_code(triangle.centre(), box));
    });
    // A new cluster starts with each of six directions and with each equal share of the power that they leave.
    const float share = total_power / static_cast<float>(most_emitter_pieces - 6);
    std::vector<EmitterPiece> pieces;
    for (std::size_t first = 0; first < triangles.size();) {
        glm::vec3 centre(0.0f), vector_area(0.0f), radiance(0.0f);
        float area = 0.0f, power = 0.0f;
        std::size_t next = first;
        while (next < triangles.size() && facing_axis(triangles[next]) == facing_axis(triangles[first]) &&
               power < share) {
            const EmissiveTriangle& triangle = triangles[next++];
            centre += triangle.area() * triangle.centre();
            radiance += triangle.area() * triangle.radiance;
            vector_area += triangle.vector_area;
            area += triangle.area(), power += triangle.power();
        }
        // As long as the whole area: what a cluster's facets that face apart take from their sum would be lost power.
        const glm::vec3 facing = vector_area / std::max(glm::length(vector_area), 1e-30f);
        pieces.push_back(piece(centre / area, area * facing, glm::vec3(0.0f), radiance / area));
        first = next;
    }
    return pieces;
}

// Points that stand for the surface: its centre of area, or `count` points spread evenly over it.
std::vector<glm::vec3> spread_points(const std::vector<EmissiveTriangle>& triangles, int count) {
    double total_area = 0.0;
    glm::dvec3 centre(0.0);
    for (const EmissiveTriangle& triangle : triangles) {
        total_area += triangle.area();
        centre += static_cast<double>(triangle.area()) * glm::dvec3(triangle.centre());
    }
    if (count == 1) return {glm::vec3(centre / total_area)};
    std::vector<glm::vec3> points;
    std::size_t at = 0;
    double before = 0.0;  // area of the triangles before `at`
    for (int i = 0; i < count; ++i) {
        const double target = (i + 0.5) / count * total_area;
        while (at + 1 < triangles.size() && before + triangles[at].area() < target) before += triangles[at++].area();
        // Points of Roberts' R2 sequence, folded into the triangle.
        double u = std::fmod(0.5 + 0.7548776662466927 * i, 1.0), v = std::fmod(0.5 + 0.5698402909980532 * i, 1.0);
        if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
        const EmissiveTriangle& triangle = triangles[at];
        points.push_back(triangle.a + static_cast<float>(u) * (triangle.b - triangle.a) +
                         static_cast<float>(v) * (triangle.c - triangle.a));
    }
    return points;
}

glm::vec4 front_plane(const std::vector<EmissiveTriangle>& triangles) {
    glm::vec3 vector_area(0.0f);
    Bounds box;
    for (const EmissiveTriangle& triangle : triangles) {
        vector_area += triangle.vector_area;
        for (const glm::vec3& corner : {triangle.a, triangle.b, triangle.c}) box.add(corner);
    }
    const glm::vec3 normal = vector_area / std::max(glm::length(vector_area), 1e-30f);
    const glm::vec4 plane(normal, -glm::dot(normal, triangles.front().a));
    for (const EmissiveTriangle& triangle : triangles) {
        for (const glm::vec3& corner : {triangle.a, triangle.b, triangle.c}) {
            // Flat to a thousandth of its size: what that hides or shows is far below a texel.
            if (std::abs(glm::dot(plane, glm::vec4(corner, 1.0f))) > 1e-3f * box.diagonal())
                return {0.0f, 0.0f, 0.0f, 1.0f};
        }
    }
    return plane;
}

}  // namespace

std::vector<EmitterLight> find_emitters(const Scene& scene, int sample_points) {
    std::vector<EmitterLight> emitters;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Material& material = scene.materials[scene.meshes[scene.instances[i].mesh].material];
        if (!material.is_emissive()) continue;
        std::vector<EmissiveTriangle> triangles = emissive_triangles(scene, scene.instances[i]);
        if (triangles.empty()) continue;
        EmitterLight emitter;
        emitter.instance = static_cast<int>(i);
        emitter.both_sides = material.two_sided && !is_closed(triangles);
        emitter.sample_points = spread_points(triangles, sample_points);
        if (!emitter.both_sides) emitter.front_plane = front_plane(triangles);
        emitter.discs = triangles.size() > most_emitter_pieces;
        if (emitter.discs) {
            emitter.pieces = cluster(std::move(triangles));
        } else {
            for (const EmissiveTriangle& t : triangles) emitter.pieces.push_back(piece(t.a, t.b, t.c, t.radiance));
        }
        emitters.push_back(std::move(emitter));
    }
    return emitters;
}

}  // namespace plumb

#include "rasterizer/light_volumes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <glm/gtc/constants.hpp>

#include "rasterizer/scene_reach.h"

namespace plumb {
namespace {

// A cone wider than this (half angle, radians) covers nearly as much as its sphere.
constexpr float widest_cone = 1.1f;

float strongest_channel(const glm::vec3& intensity) { return std::max({intensity.x, intensity.y, intensity.z}); }

glm::mat4 scaled_sphere(const glm::vec3& position, float radius) {
    glm::mat4 matrix(radius);
    matrix[3] = glm::vec4(position, 1.0f);
    return matrix;
}

glm::mat4 scaled_cone(const SpotLight& light, float radius) {
    const glm::vec3 backwards = -light.direction;
    const glm::vec3 helper = std::abs(backwards.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 right = glm::normalize(glm::cross(helper, backwards));
    const glm::vec3 up = glm::cross(backwards, right);
    const float side = radius * std::tan(light.outer_angle);
    return {glm::vec4(side * right, 0.0f), glm::vec4(side * up, 0.0f), glm::vec4(radius * backwards, 0.0f),
            glm::vec4(light.position, 1.0f)};
}

}  // namespace

float light_radius(const Attenuation& attenuation, float strongest, float threshold, VolumeRadius defined_by) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const bool ogldev = defined_by == VolumeRadius::ogldev_code;
    if (ogldev && attenuation.quadratic == 0.0f) return static_cast<float>(infinity);
    const double a = attenuation.quadratic, b = attenuation.linear;
    // a d^2 + b d + c = 0
    const double constant = ogldev ? attenuation.quadratic : attenuation.constant;
    const double c = constant - static_cast<double>(strongest) / threshold;
    if (c >= 0.0) return 0.0f;
    if (a > 0.0) {
        // The form without cancellation where b^2 outweighs the rest.
        return static_cast<float>(-2.0 * c / (b + std::sqrt(b * b - 4.0 * a * c)));
    }
    return static_cast<float>(b > 0.0 ? -c / b : infinity);
}

LightVolumes::LightVolumes(const Scene& scene, float threshold, VolumeRadius defined_by) {
    const Bounds bounds = bounds_over_time(scene);
    const auto radius_of = [&](const auto& light) {
        return std::min(light_radius(light.attenuation, strongest_channel(light.intensity), threshold, defined_by),
                        reach(bounds, light.position));
    };
    for (std::size_t i = 0; i < scene.point_lights.size(); ++i) {
        const PointLight& light = scene.point_lights[i];
        const float radius = radius_of(light);
        if (radius > 0.0f) point_spheres.push_back({scaled_sphere(light.position, radius), static_cast<int>(i)});
    }
    for (std::size_t i = 0; i < scene.spot_lights.size(); ++i) {
        const SpotLight& light = scene.spot_lights[i];
        const float radius = radius_of(light);
        if (!(radius > 0.0f)) continue;
        if (light.outer_angle > widest_cone) {
            spot_spheres.push_back({scaled_sphere(light.position, radius), static_cast<int>(i)});
        } else {
            spot_cones.push_back({scaled_cone(light, radius), static_cast<int>(i)});
        }
    }
}

VolumeMesh enclosing_sphere(int subdivisions) {
    const float golden = glm::golden_ratio<float>();
    VolumeMesh mesh;
    for (const float x : {-1.0f, 1.0f}) {
        for (const float y : {-golden, golden}) {
            mesh.positions.insert(mesh.positions.end(), {{0.0f, x, y}, {x, y, 0.0f}, {y, 0.0f, x}});
        }
    }
    for (glm::vec3& p : mesh.positions) p = glm::normalize(p);
    // Faces of the icosahedron: three corners that are all one edge's length apart.
    const auto edge = [&](unsigned i, unsigned j) {
        return glm::distance(mesh.positions[i], mesh.positions[j]) < 1.2f;
    };
    for (unsigned i = 0; i < 12; ++i) {
        for (unsigned j = i + 1; j < 12; ++j) {
            for (unsigned k = j + 1; k < 12; ++k) {
                if (!edge(i, j) || !edge(j, k) || !edge(k, i)) continue;
                const glm::vec3 &a = mesh.positions[i], &b = mesh.positions[j], &c = mesh.positions[k];
                const bool outwards = glm::dot(glm::cross(b - a, c - a), a) > 0.0f;
                mesh.indices.insert(mesh.indices.end(), {i, outwards ? j : k, outwards ? k : j});
            }
        }
    }
    for (int step = 0; step < subdivisions; ++step) {
        std::map<std::pair<unsigned, unsigned>, unsigned> middles;
        const auto middle = [&](unsigned i, unsigned j) {
            const auto [entry, added] =
                middles.emplace(std::minmax(i, j), static_cast<unsigned>(mesh.positions.size()));
            if (added) mesh.positions.push_back(glm::normalize(mesh.positions[i] + mesh.positions[j]));
            return entry->second;
        };
        std::vector<std::uint32_t> finer;
        for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
            const unsigned a = mesh.indices[t], b = mesh.indices[t + 1], c = mesh.indices[t + 2];
            const unsigned ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
        }
        mesh.indices = std::move(finer);
    }
    float nearest_facet = 1.0f;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const glm::vec3 &a = mesh.positions[mesh.indices[t]], &b = mesh.positions[mesh.indices[t + 1]],
                        &c = mesh.positions[mesh.indices[t + 2]];
        nearest_facet = std::min(nearest_facet, glm::dot(a, glm::normalize(glm::cross(b - a, c - a))));
    }
    // A little more, for the rounding of the facets' corners.
    for (glm::vec3& p : mesh.positions) p *= 1.0001f / nearest_facet;
    return mesh;
}

VolumeMesh enclosing_cone(int sides) {
    VolumeMesh mesh;
    // A regular polygon around the circle; a little more, for rounding.
    const float radius = 1.0001f / std::cos(glm::pi<float>() / static_cast<float>(sides));
    mesh.positions.push_back({0.0f, 0.0f, 0.0f});
    for (int i = 0; i < sides; ++i) {
        const float angle = glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(sides);
        mesh.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), -1.0001f});
    }
    const auto count = static_cast<unsigned>(sides);
    const auto corner = [&](unsigned i) { return 1 + i % count; };
    for (unsigned i = 0; i < count; ++i) {
        mesh.indices.insert(mesh.indices.end(), {0, corner(i), corner(i + 1)});
        if (i + 2 < count) mesh.indices.insert(mesh.indices.end(), {corner(0), corner(i + 2), corner(i + 1)});
    }
    return mesh;
}

Bounds volume_bounds(const LightVolume& volume, float extent) {
    const glm::mat4& m = volume.world_from_unit;
    const glm::vec3 half = extent * (glm::abs(glm::vec3(m[0])) + glm::abs(glm::vec3(m[1])) + glm::abs(glm::vec3(m[2])));
    Bounds bounds;
    bounds.add(glm::vec3(m[3]) - half);
    bounds.add(glm::vec3(m[3]) + half);
    return bounds;
}

}  // namespace plumb

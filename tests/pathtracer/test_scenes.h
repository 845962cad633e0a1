// Small scenes with known answers, and statistical comparison with them.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "pathtracer/reference.h"
#include "scenes/scene.h"

namespace plumb {

// Adds a material and returns its index.
inline int add_material(Scene& scene, const glm::vec3& albedo, const glm::vec3& emission = glm::vec3(0.0f),
                        bool two_sided = true) {
    Material material;
    material.base_colour = albedo;
    material.emission = emission;
    material.two_sided = two_sided;
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
}

// Adds a convex polygon, counter-clockwise seen from its front, as one instance.
inline void add_polygon(Scene& scene, int material, const std::vector<glm::dvec3>& polygon) {
    Mesh mesh;
    mesh.material = material;
    for (const glm::dvec3& corner : polygon) mesh.positions.emplace_back(corner);
    for (unsigned i = 2; i < polygon.size(); ++i) mesh.triangles.push_back({0, i - 1, i});
    scene.instances.push_back({"polygon", static_cast<int>(scene.meshes.size())});
    scene.meshes.push_back(mesh);
}

// Adds a mesh of quads, each counter-clockwise seen from its front, as one instance.
inline void add_quads(Scene& scene, int material, const std::vector<std::vector<glm::vec3>>& quads,
                      const glm::mat4& world_from_object = glm::mat4(1.0f)) {
    Mesh mesh;
    mesh.material = material;
    for (const auto& quad : quads) {
        const auto first = static_cast<unsigned>(mesh.positions.size());
        for (const glm::vec3& corner : quad) mesh.positions.push_back(corner);
        for (const glm::vec2 uv : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
            mesh.uvs.push_back(uv);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    }
    scene.instances.push_back({"quads", static_cast<int>(scene.meshes.size()), world_from_object});
    scene.meshes.push_back(mesh);
}

// An equirectangular sky of 16 x 8 texels with a sun, darkness below and a turn.
inline Scene sky_scene() {
    Scene scene;
    Texture sky;
    sky.width = 16, sky.height = 8, sky.wrap_v = TextureWrap::clamp;
    for (int j = 0; j < 8; ++j) {
        for (int i = 0; i < 16; ++i) {
            const float value = i == 3 && j == 2 ? 30.0f : j > 5 ? 0.0f : 0.1f * static_cast<float>(1 + (i * j) % 5);
            sky.texels.insert(sky.texels.end(), {half(value), half(value), half(value), half(1.0f)});
        }
    }
    scene.textures.push_back(sky);
    scene.environment = {glm::vec3(1.0f), 0, 1.3f};
    return scene;
}

// A sky that grows brighter towards one side and towards the zenith, with one bright texel.
inline void add_uneven_sky(Scene& scene) {
    Texture sky;
    sky.width = 32, sky.height = 16, sky.wrap_v = TextureWrap::clamp;
    for (int j = 0; j < sky.height; ++j) {
        for (int i = 0; i < sky.width; ++i) {
            const float ramp = 0.5f + 0.05f * static_cast<float>(31 - std::abs(i - 16) - j);
            const half bright = i == 9 && j == 3 ? 30.0f : ramp;
            sky.texels.insert(sky.texels.end(), {bright, bright, bright, half(1.0f)});
        }
    }
    scene.environment = {glm::vec3(1.0f), static_cast<int>(scene.textures.size()), 0.4f};
    scene.textures.push_back(sky);
}

// The horizontal square |x|, |z| <= half at height y, seen from above.
inline std::vector<glm::vec3> floor_quad(float half, float y = 0.0f) {
    return {{-half, y, half}, {half, y, half}, {half, y, -half}, {-half, y, -half}};
}

// The six faces of the cube |x|, |y|, |z| <= 1, fronts inwards.
inline std::vector<std::vector<glm::vec3>> room_quads() {
    std::vector<std::vector<glm::vec3>> quads;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
            glm::vec3 centre(0.0f), u(0.0f), v(0.0f);
            centre[axis] = side, u[(axis + 1) % 3] = 1.0f, v[(axis + 2) % 3] = -side;
            quads.push_back({centre - u - v, centre + u - v, centre + u + v, centre - u + v});
        }
    }
    return quads;
}

// A unit ball of 8 * 4^subdivisions triangles, with the normals of a sphere.
inline void add_smooth_ball(Scene& scene, int material, int subdivisions, const glm::vec3& centre = glm::vec3(0.0f)) {
    using Triangle = std::array<glm::vec3, 3>;
    std::vector<Triangle> triangles;
    for (int octant = 0; octant < 8; ++octant) {
        const glm::vec3 x((octant & 1) != 0 ? 1 : -1, 0, 0), y(0, (octant & 2) != 0 ? 1 : -1, 0),
            z(0, 0, (octant & 4) != 0 ? 1 : -1);
        triangles.push_back(x.x * y.y * z.z > 0.0f ? Triangle{x, y, z} : Triangle{x, z, y});
    }
    for (int i = 0; i < subdivisions; ++i) {
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : triangles) {
            const glm::vec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        triangles = finer;
    }
    Mesh mesh;
    mesh.material = material;
    for (const Triangle& triangle : triangles) {
        const auto first = static_cast<unsigned>(mesh.positions.size());
        for (const glm::vec3& corner : triangle) mesh.positions.push_back(corner), mesh.normals.push_back(corner);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    scene.instances.push_back({"ball", static_cast<int>(scene.meshes.size()), glm::translate(glm::mat4(1.0f), centre)});
    scene.meshes.push_back(mesh);
}

// A view of `size` x `size` pixels.
inline View view_of(const glm::vec3& eye, const glm::vec3& target, float field_of_view = 0.6f, int size = 16,
                    const glm::vec3& up = {0.0f, 1.0f, 0.0f}) {
    Camera camera = Camera::look_at("test", eye, target, field_of_view, up);
    camera.near_plane = 1e-3f, camera.far_plane = 1e4f;
    return View(camera, size, size);
}

inline ReferenceSettings settings_for(std::vector<std::string> planes, int samples, int bounces = 1) {
    ReferenceSettings settings;
    settings.quantities.planes = std::move(planes);
    settings.quantities.bounces = bounces;
    settings.samples = samples;
    return settings;
}

inline glm::vec3 colour_at(const Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

// The mean over the pixels of `plane` must be that of `expected` (a function of pixel x, y) within four standard
// errors, which a right program misses once in 16 000 tests with other seeds, plus 2e-5 of the value for float32. Every
// channel is looked at.
//   `tolerance`: how far, of the expected value, a right answer may rightly lie apart, as a tessellation does.
//   `power`: the very same data must be rejected once so much of the expected value is added to it or taken away, or
//   the test would prove little.
//   `colour`: by what each channel's expectation is multiplied.
inline void expect_mean(const Frame& frame, const std::string& plane, const std::function<double(int, int)>& expected,
                        const std::string& what = "", double tolerance = 0.0, double power = 0.01,
                        const glm::dvec3& colour = glm::dvec3(1.0)) {
    const Image& image = frame.plane(plane);
    const Image& variance = frame.plane("variance." + plane);
    double expected_sum = 0.0;
    glm::dvec3 sum(0.0), variance_sum(0.0);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            expected_sum += expected(x, y);
            for (int c = 0; c < image.channels(); ++c) {
                sum[c] += image.at(x, y, c);
                variance_sum[c] += variance.at(x, y, c);
            }
        }
    }
    const auto count = static_cast<double>(image.pixel_count());
    for (int c = 0; c < image.channels(); ++c) {
        const double mean = sum[c] / count, expected_mean = colour[c] * expected_sum / count,
                     standard_error = std::sqrt(variance_sum[c]) / count;
        const auto distance_beyond_chance = [&](double expectation) {
            return std::abs(mean - expectation) - 4.0 * standard_error - (2e-5 + tolerance) * std::abs(expectation);
        };
        const std::string where = fmt::format("{} plane {}, channel {}, standard error {}, mean {} for {}", what, plane,
                                              c, standard_error, mean, expected_mean);
        EXPECT_LE(distance_beyond_chance(expected_mean), 0.0) << where;
        if (expected_mean == 0.0) {
            EXPECT_EQ(standard_error, 0.0) << where;
            continue;
        }
        for (const double factor : {1.0 + power, 1.0 - power}) {
            EXPECT_GT(distance_beyond_chance(factor * expected_mean), 0.0)
                << where << ": would not see the expectation times " << factor;
        }
    }
}

inline void expect_mean(const Frame& frame, const std::string& plane, double expected, const std::string& what = "",
                        double tolerance = 0.0, double power = 0.01, const glm::dvec3& colour = glm::dvec3(1.0)) {
    expect_mean(
        frame, plane, [expected](int, int) { return expected; }, what, tolerance, power, colour);
}

// Both frames hold the same planes with the same bits (and infinities where the other has them).
inline void expect_same_bits(const Frame& a, const Frame& b) {
    ASSERT_EQ(a.plane_names(), b.plane_names());
    for (const std::string& plane : a.plane_names()) {
        const auto values_a = a.plane(plane).values(), values_b = b.plane(plane).values();
        std::size_t different = 0;
        for (std::size_t i = 0; i < values_a.size(); ++i) different += values_a[i] == values_b[i] ? 0 : 1;
        EXPECT_EQ(different, 0u) << "values of plane " << plane << " differ, of " << values_a.size();
    }
}

}  // namespace plumb

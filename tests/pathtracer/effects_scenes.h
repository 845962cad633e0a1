// Materials, views and comparisons that the tests of lobes, panes, lens and motion share.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include "scenes/specular_albedo.h"
#include "tests/pathtracer/test_scenes.h"

namespace plumb {

inline int add_metal(Scene& scene, const glm::vec3& reflectance, float roughness) {
    const int index = add_material(scene, reflectance);
    Material& material = scene.materials.back();
    material.metallic = 1.0f, material.roughness = roughness;
    return index;
}

inline int add_dielectric(Scene& scene, const glm::vec3& albedo, float roughness, float reflectance = 0.04f) {
    const int index = add_material(scene, albedo);
    Material& material = scene.materials.back();
    material.dielectric_reflectance = reflectance, material.roughness = roughness;
    return index;
}

inline int add_pane(Scene& scene, const glm::vec3& transmission, const glm::vec3& albedo = glm::vec3(0.0f)) {
    const int index = add_material(scene, albedo);
    scene.materials.back().transmission = transmission;
    return index;
}

inline std::string name_of(EmitterSampling strategy) {
    static const char* const names[] = {"lights", "directions", "both"};
    return names[static_cast<int>(strategy)];
}
constexpr EmitterSampling all_strategies[] = {EmitterSampling::lights, EmitterSampling::directions,
                                              EmitterSampling::both};

// Where the ray through a pixel's centre meets the plane dot(normal, p) = offset, and where it goes from there when it
// is mirrored. In double, so that it owes nothing to the path tracer's arithmetic.
struct PixelRay {
    glm::dvec3 origin, direction;

    PixelRay(const View& view, int x, int y) {
        const Ray ray = view.pixel_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        origin = ray.origin, direction = glm::normalize(glm::dvec3(ray.direction));
    }
    glm::dvec3 on_plane(const glm::dvec3& normal, double offset) const {
        return origin + direction * ((offset - glm::dot(normal, origin)) / glm::dot(normal, direction));
    }
    // From the plane on.
    PixelRay mirrored(const glm::dvec3& normal, double offset) const {
        PixelRay ray = *this;
        ray.origin = on_plane(normal, offset);
        ray.direction = direction - 2.0 * glm::dot(direction, normal) * normal;
        return ray;
    }
};

// Schlick's term for a metal, at that cosine.
inline glm::dvec3 fresnel_of_metal(const glm::dvec3& reflectance, double cosine) {
    return reflectance + (1.0 - reflectance) * std::pow(1.0 - cosine, 5.0);
}

// Every pixel of `plane` is `expected(x, y)`: a value that is the same for each sample, so both halves are the very
// same and only the rounding of float32 remains, by default of some ten operations. Returns how many were not black.
template <typename Expected>
int expect_exactly(const Frame& frame, const std::string& plane, const Expected& expected, const std::string& what = "",
                   double tolerance = 2e-6) {
    const Image& image = frame.plane(plane);
    int lit = 0;
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            const glm::dvec3 wanted = expected(x, y);
            lit += wanted != glm::dvec3(0.0) ? 1 : 0;
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(image.at(x, y, c), wanted[c], tolerance * wanted[c])
                    << what << " plane " << plane << " at " << x << ", " << y << ", channel " << c;
                EXPECT_EQ(frame.plane("half_a." + plane).at(x, y, c), frame.plane("half_b." + plane).at(x, y, c))
                    << what << ": noise in plane " << plane << " at " << x << ", " << y;
            }
        }
    }
    return lit;
}

}  // namespace plumb

// Light from all around, integrated over directions on the CPU: the formulas of rasterizer/radiance_maps.h in double
// precision, and a sky that tells directions apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "rasterizer/cube_faces.h"
#include "rasterizer/radiance_maps.h"
#include "scenes/ggx.h"
#include "scenes/scene.h"

namespace plumb::counterpart {

using Radiance = std::function<glm::dvec3(const glm::dvec3& direction)>;

// The direction of a texel of a face as read back: its top row first.
inline glm::dvec3 direction_of(int face, int x, int y, int size) {
    const CubeFace& cube_face = cube_faces[static_cast<std::size_t>(face)];
    const glm::dvec3 forward(cube_face.forward), up(cube_face.up);
    const double s = 2.0 * (x + 0.5) / size - 1.0, t = 1.0 - 2.0 * (y + 0.5) / size;
    return glm::normalize(forward + s * glm::cross(forward, up) + t * up);
}

// Sums weight(d) L(d) over the sphere, by equal steps of the cosine of the polar angle about `axis` and of the azimuth.
inline glm::dvec3 integrate(const Radiance& radiance, const glm::dvec3& axis,
                            const std::function<double(double)>& weight, bool normalised, int rows, int columns) {
    constexpr double pi = std::numbers::pi;
    const glm::dvec3 helper = std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(helper, axis)), v = glm::cross(axis, u);
    glm::dvec3 sum(0.0);
    double total = 0.0;
    for (int i = 0; i < rows; ++i) {
        // Finer towards the axis, where lobes are: the cosine is 1 - 2 q^2, which q's steps cover with weight 4 q.
        const double q = (i + 0.5) / rows, cosine = 1.0 - 2.0 * q * q;
        const double share = weight(cosine) * 4.0 * q / rows * 2.0 * pi / columns;
        if (share == 0.0) continue;
        const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
        for (int j = 0; j < columns; ++j) {
            const double azimuth = 2.0 * pi * (j + 0.5) / columns;
            sum += share * radiance(sine * std::cos(azimuth) * u + sine * std::sin(azimuth) * v + cosine * axis);
            total += share;
        }
    }
    return normalised ? sum / total : sum;
}

inline glm::dvec3 irradiance(const Radiance& radiance, const glm::dvec3& normal, int rows = 200, int columns = 200) {
    return integrate(
        radiance, normal, [](double cosine) { return std::max(0.0, cosine); }, false, rows, columns);
}

// The lobe of the split sum: D(h) (r.d) with h half way between r and d.
inline glm::dvec3 prefiltered(const Radiance& radiance, const glm::dvec3& r, double alpha, int rows = 600) {
    const auto lobe = [alpha](double cosine) {
        if (cosine <= 0.0) return 0.0;
        const double square = 0.5 * (1.0 + cosine);  // of the cosine of half the angle
        return ggx_distribution(std::sqrt(square), 1.0 - square, alpha) * cosine;
    };
    return integrate(radiance, r, lobe, true, rows, rows / 6);
}

// What the levels of the prefiltered cube make of a roughness between theirs.
inline glm::dvec3 glossy_radiance(const Radiance& radiance, const glm::dvec3& r, double roughness, int rows = 600) {
    const double level = roughness * (prefiltered_levels - 1), finer = std::floor(level);
    const auto of_level = [&](double l) {
        const double its_roughness = l / (prefiltered_levels - 1);
        return l == 0.0 ? radiance(r) : prefiltered(radiance, r, its_roughness * its_roughness, rows);
    };
    return level == finer ? of_level(finer) : glm::mix(of_level(finer), of_level(finer + 1.0), level - finer);
}

// Bright upwards and to one side, with some structure a few tens of degrees wide, and a tint and a turn of its own.
inline void give_sky(Scene& scene) {
    constexpr double pi = std::numbers::pi;
    Texture sky;
    sky.width = 256, sky.height = 128, sky.wrap_v = TextureWrap::clamp;
    for (int y = 0; y < sky.height; ++y) {
        for (int x = 0; x < sky.width; ++x) {
            const double polar = pi * (y + 0.5) / sky.height, azimuth = 2.0 * pi * (x + 0.5) / sky.width;
            const double value = 1.0 + 0.8 * std::cos(polar) + 0.5 * std::sin(polar) * std::sin(3.0 * azimuth);
            const double glow = 3.0 * std::exp(-20.0 * (1.0 - std::sin(polar) * std::cos(azimuth - 1.0)));
            for (const double channel : {value + glow, 0.5 * value, 0.3 + glow, 1.0})
                sky.texels.push_back(half(static_cast<float>(channel)));
        }
    }
    scene.environment = {{1.0f, 2.0f, 0.5f}, static_cast<int>(scene.textures.size()), 0.4f};
    scene.textures.push_back(sky);
}

}  // namespace plumb::counterpart

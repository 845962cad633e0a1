#include "rasterizer/environment_light.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "rasterizer/scene_texture.h"

namespace plumb {
namespace {

// Real spherical harmonics up to order 2 at a unit direction.
std::array<float, 9> harmonics(const glm::vec3& d) {
    return {0.282095f,
            0.488603f * d.y,
            0.488603f * d.z,
            0.488603f * d.x,
            1.092548f * d.x * d.y,
            1.092548f * d.y * d.z,
            0.315392f * (3 * d.z * d.z - 1),
            1.092548f * d.x * d.z,
            0.546274f * (d.x * d.x - d.y * d.y)};
}

}  // namespace

IrradianceCoefficients project_irradiance(const Scene& scene) {
    IrradianceCoefficients coefficients{};
    // Integral of the clamped cosine against each band.
    constexpr float pi = glm::pi<float>();
    constexpr std::array<float, 9> cosine{pi,     2 * pi / 3, 2 * pi / 3, 2 * pi / 3, pi / 4,
                                          pi / 4, pi / 4,     pi / 4,     pi / 4};
    if (scene.environment.texture == no_texture) {
        // Exactly pi times the radiance: the polynomial of order 0 is constant.
        coefficients[0] = scene.environment.radiance * pi / 0.282095f;
        return coefficients;
    }
    // Two directions per texel of the longer side suffice for nine smooth polynomials; more than 1024 adds nothing.
    const Texture& texture = scene.textures[scene.environment.texture];
    const int columns = std::clamp(texture.width, 64, 1024), rows = std::clamp(texture.height, 32, 512);
    std::array<glm::dvec3, 9> sums{};
    double total_weight = 0.0;
    for (int row = 0; row < rows; ++row) {
        const float polar = pi * (static_cast<float>(row) + 0.5f) / static_cast<float>(rows);
        for (int column = 0; column < columns; ++column) {
            const float azimuth = 2 * pi * (static_cast<float>(column) + 0.5f) / static_cast<float>(columns);
            const glm::vec3 direction(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                      std::sin(polar) * std::sin(azimuth));
            const double weight = std::sin(static_cast<double>(polar));
            total_weight += weight;
            const glm::dvec3 radiance(scene.environment_radiance(direction));
            const std::array<float, 9> basis = harmonics(direction);
            for (int k = 0; k < 9; ++k) sums[k] += weight * radiance * static_cast<double>(basis[k]);
        }
    }
    for (int k = 0; k < 9; ++k) {
        coefficients[k] = glm::vec3(4.0 * glm::pi<double>() / total_weight * sums[k]) * cosine[k];
    }
    return coefficients;
}

glm::vec3 irradiance_from(const IrradianceCoefficients& coefficients, const glm::vec3& normal) {
    const std::array<float, 9> basis = harmonics(normal);
    glm::vec3 irradiance(0.0f);
    for (int k = 0; k < 9; ++k) irradiance += coefficients[k] * basis[k];
    return glm::max(irradiance, glm::vec3(0.0f));
}

EnvironmentLight::EnvironmentLight(GlContext& context, const Scene& scene) : scene_(scene) {
    if (scene.environment.texture == no_texture) return;
    texture_ = upload(context, scene.textures[scene.environment.texture]);
}

ShaderDefines EnvironmentLight::radiance_defines(GLuint unit) const {
    if (scene_.environment.texture == no_texture) return {};
    return {{"ENVIRONMENT_TEXTURE_UNIT", fmt::format("{}", unit)}};
}

void EnvironmentLight::set_radiance(const Program& program, GLuint unit) const {
    program.set("environment_tint", scene_.environment.radiance);
    if (scene_.environment.texture == no_texture) return;
    program.set("environment_rotation", scene_.environment.rotation);
    texture_.bind(unit);
}

}  // namespace plumb

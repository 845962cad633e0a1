// The environment as shaders see it (environment.glsl): radiance by direction, and irradiance by normal.
//
// Irradiance is that of the radiance's projection on spherical harmonics up to order 2, convolved with the cosine.
//   Source: Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps": the mean
//   error is about 1 % for natural skies; a small very bright sun rings, and negative lobes are cut at zero. A constant
//   environment is exact.
#pragma once

#include <array>

#include "rasterizer/shader.h"
#include "scenes/scene.h"

namespace plumb {

// Coefficients of the irradiance per channel, ready to be multiplied with the nine polynomials of irradiance_from().
using IrradianceCoefficients = std::array<glm::vec3, 9>;
IrradianceCoefficients project_irradiance(const Scene& scene);
glm::vec3 irradiance_from(const IrradianceCoefficients& coefficients, const glm::vec3& normal);

// Uploads the environment's texture, if it has one, and sets uniforms.
class EnvironmentLight {
public:
    EnvironmentLight(GlContext& context, const Scene& scene);

    // For a shader that calls environment_radiance(). The texture goes to `unit`.
    void set_radiance(const Program& program, GLuint unit) const;
    ShaderDefines radiance_defines(GLuint unit) const;

private:
    const Scene& scene_;
    GlTexture texture_;
};

}  // namespace plumb

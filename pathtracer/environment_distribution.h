// Directions towards a bright equirectangular environment.
#pragma once

#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "pathtracer/discrete_distribution.h"
#include "scenes/scene.h"

namespace plumb {

struct EnvironmentSample {
    glm::vec3 direction{0.0f};
    float density = 0.0f;  // per solid angle
};

// Chooses a texel by the luminance of its bilinearly filtered radiance times its solid angle, and a direction uniformly
// (in texture coordinates) within it. Wherever there is radiance the density is positive.
class EnvironmentDistribution {
public:
    EnvironmentDistribution() = default;
    // Empty for a constant or a black environment.
    explicit EnvironmentDistribution(const Scene& scene);

    bool empty() const { return rows_.empty(); }
    EnvironmentSample sample(glm::vec2 u) const;
    float density(const glm::vec3& direction) const;

private:
    float density(int column, int row, float sin_theta) const;

    const Environment* environment_ = nullptr;
    int width_ = 0, height_ = 0;
    DiscreteDistribution rows_;
    std::vector<DiscreteDistribution> columns_;
};

}  // namespace plumb

#include "pathtracer/environment_distribution.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include "frames/parallel.h"
#include "pathtracer/luminance.h"

namespace plumb {

EnvironmentDistribution::EnvironmentDistribution(const Scene& scene) {
    if (scene.environment.is_black() || scene.environment.texture == no_texture) return;
    const Texture& texture = scene.textures[scene.environment.texture];
    environment_ = &scene.environment;
    width_ = texture.width, height_ = texture.height;

    columns_.resize(height_);
    std::vector<double> row_weights(height_);
    parallel_for(height_, [&](int row) {
        const float sin_theta =
            std::sin(glm::pi<float>() * (static_cast<float>(row) + 0.5f) / static_cast<float>(height_));
        std::vector<double> weights(width_);
        for (int column = 0; column < width_; ++column) {
            // Within a texel the filtered radiance is bilinear over each quarter: with its values at the 3x3 corners of
            // the quarters the trapezoidal rule (weights 1 2 1) is exact, and 0 only where the radiance is.
            double sum = 0.0;
            for (int j = 0; j < 3; ++j) {
                for (int i = 0; i < 3; ++i) {
                    const glm::vec2 uv(
                        (static_cast<float>(column) + 0.5f * static_cast<float>(i)) / static_cast<float>(width_),
                        (static_cast<float>(row) + 0.5f * static_cast<float>(j)) / static_cast<float>(height_));
                    const float value = luminance(scene.environment.radiance * glm::vec3(texture.sample(uv)));
                    sum += (i == 1 ? 2.0 : 1.0) * (j == 1 ? 2.0 : 1.0) / 16.0 * std::max(value, 0.0f);
                }
            }
            weights[column] = sum * sin_theta;
        }
        columns_[row] = DiscreteDistribution(weights);
        row_weights[row] = columns_[row].sum();
    });
    rows_ = DiscreteDistribution(row_weights);
}

EnvironmentSample EnvironmentDistribution::sample(glm::vec2 u) const {
    const std::size_t row = rows_.sample(u.y);
    const DiscreteDistribution& columns = columns_[row];
    const std::size_t column = columns.sample(u.x);
    const float x = static_cast<float>((static_cast<double>(column) + columns.within(u.x, column)) / width_);
    const float y = static_cast<float>((static_cast<double>(row) + rows_.within(u.y, row)) / height_);
    // The inverse of Environment::texture_coordinates.
    const float longitude = glm::two_pi<float>() * (x - 0.5f) - environment_->rotation;
    const float theta = glm::pi<float>() * y;
    const float sin_theta = std::sin(theta);
    return {{std::sin(longitude) * sin_theta, std::cos(theta), -std::cos(longitude) * sin_theta},
            density(static_cast<int>(column), static_cast<int>(row), sin_theta)};
}

float EnvironmentDistribution::density(const glm::vec3& direction) const {
    const glm::vec2 uv = environment_->texture_coordinates(direction);
    const int column = std::clamp(static_cast<int>(uv.x * static_cast<float>(width_)), 0, width_ - 1);
    const int row = std::clamp(static_cast<int>(uv.y * static_cast<float>(height_)), 0, height_ - 1);
    return density(column, row, std::hypot(direction.x, direction.z));
}

// A texel of the unit square is 2 pi^2 sin(theta) / (width height) steradians.
float EnvironmentDistribution::density(int column, int row, float sin_theta) const {
    const double probability = columns_[row].empty() ? 0.0 : rows_.probability(row) * columns_[row].probability(column);
    if (!(probability > 0.0) || !(sin_theta > 0.0f)) return 0.0f;
    constexpr double two_pi_squared = 2.0 * glm::pi<double>() * glm::pi<double>();
    return static_cast<float>(probability * width_ * height_ / (two_pi_squared * sin_theta));
}

}  // namespace plumb

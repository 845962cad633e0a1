// Ambient obscurance on the CPU, from the formulas of rasterizer/ambient_obscurance.h.
#pragma once

#include <numbers>

#include "frames/quantities.h"
#include "sample_spiral_counterpart.h"

namespace plumb::counterpart {

struct Visibility {
    double mean = 0.0;  // of the taps' obscurance, before the estimator's curve
    double visibility = 1.0;
    bool ambiguous = false;
};

inline Visibility ambient_visibility(const Layers& layers, const AmbientObscuranceSettings& settings,
                                     const Quantities& quantities, Pixel pixel) {
    using Estimator = AmbientObscuranceEstimator;
    const double depth = depth_at(layers, 0, pixel), radius = quantities.ao_radius;
    const double radius_pixels = depth > 0.0 ? layers.view.pixels_per_metre() * radius / depth : 0.0;
    if (radius_pixels < 1.0) return {};

    Visibility result;
    const bool demo = settings.estimator == Estimator::g3d_demo;
    const std::vector<Tap> taps = spiral_taps(layers,
                                              {.pixel = pixel,
                                               .radius_pixels = radius_pixels,
                                               .samples = settings.samples,
                                               .jitter = 32768,
                                               .use_mip_chain = settings.use_mip_chain,
                                               .mip_offset = settings.mip_offset,
                                               .minimum_distance = demo ? 0.75 : 0.0},
                                              result.ambiguous);
    const glm::dvec3 centre = point_at(layers, 0, pixel), normal = vector_at(layers, layers.normal[0], pixel);
    double sum = 0.0;
    for (const Tap& tap : taps) {
        if (!inside(layers, tap.pixel)) continue;
        double largest = 0.0;
        for (int layer = 0; layer < settings.layers; ++layer) {
            if (depth_at(layers, layer, tap.source) == 0.0) continue;
            const glm::dvec3 v = point_at(layers, layer, tap.source) - centre;
            const double vv = glm::dot(v, v), height = std::max(0.0, glm::dot(v, normal) - settings.bias);
            const double divisor =
                settings.estimator == Estimator::sao2012 ? vv + settings.epsilon : std::sqrt(vv + settings.epsilon);
            const double relative_square = vv / (radius * radius);
            // The hard falloff jumps at the radius.
            result.ambiguous |= quantities.ao_falloff == Falloff::hard && std::abs(relative_square - 1.0) < 1e-5;
            largest = std::max(largest, falloff_of_square(quantities.ao_falloff, relative_square) * height / divisor);
        }
        sum += largest;
    }
    result.mean = sum / settings.samples;
    switch (settings.estimator) {
        case Estimator::mara2016:
            result.visibility = 1.0 - settings.intensity * std::sqrt(std::numbers::pi * result.mean);
            break;
        case Estimator::g3d_demo: {
            const double facing = 0.65 + 0.35 * std::max(0.0, 1.5 * normal.z);
            result.mean *= facing;
            result.visibility = std::pow(std::max(0.0, 1.0 - std::sqrt(3.0 * result.mean)), settings.intensity);
            result.visibility = 1.0 + std::clamp(radius_pixels - 3.0, 0.0, 1.0) * (result.visibility - 1.0);
            break;
        }
        case Estimator::sao2012: {
            const double plain = std::max(0.0, 1.0 - 5.0 * settings.intensity * result.mean);
            result.visibility = (std::pow(plain, 0.2) + 1.2 * std::pow(plain, 4.0)) / 2.2;
            break;
        }
        case Estimator::linear:
            result.visibility = 1.0 - 2.0 * settings.intensity * result.mean;
            break;
    }
    result.visibility = std::max(0.0, result.visibility);
    return result;
}

}  // namespace plumb::counterpart

// Screen-space radiosity on the CPU, from the formulas of rasterizer/radiosity.h.
#pragma once

#include <algorithm>

#include "sample_spiral_counterpart.h"

namespace plumb::counterpart {

struct Irradiance {
    glm::dvec3 irradiance{0.0};
    double confidence = 0.0;
    bool ambiguous = false;
};

inline std::uint32_t radiosity_jitter(const RadiositySettings& settings, Pixel pixel,
                                      const SpiralPattern& pattern = {}) {
    if (settings.pattern == TapPattern::nielsen2015) return even_jitter(settings.pattern, settings.samples);
    const std::uint64_t sixteen_bits = hash_of(pixel, pattern) >> 16;
    return 6554u + static_cast<std::uint32_t>(sixteen_bits * 52428u / 65536u);  // 0.1 to 0.9
}

// Whose points receive, and how many of the layers that taps look at send light.
struct GatheringLayers {
    int receiver = 0;
    int senders = 2;
};

// What one layer's point of a tap does for the receiver.
struct Received {
    glm::dvec3 light{0.0};
    bool hit = false;
};

inline Received received_from(const Layers& layers, const RadiositySettings& settings, Falloff falloff, Pixel pixel,
                              const Tap& tap, int layer, GatheringLayers of, bool& ambiguous) {
    const Pixel source = tap.source;
    if (depth_at(layers, layer, source) == 0.0) return {};
    const glm::dvec3 v = point_of_tap(layers, layer, tap, settings.mip_points) - point_at(layers, of.receiver, pixel);
    if (v == glm::dvec3(0.0)) return {};  // the shaded point itself has no direction
    const glm::dvec3 w = glm::normalize(v);
    const double cosine = glm::dot(w, vector_at(layers, layers.normal[of.receiver], pixel)),
                 relative_square = glm::dot(v, v) / (settings.radius * settings.radius);
    const double tap_cosine = -glm::dot(w, vector_at(layers, layers.normal[layer], source));
    const bool near = relative_square < 1.0;
    // Rounding may decide whether the tap lies before the pixel, in reach, or turned towards it, unless another answer
    // settles the matter.
    const bool may_face = !settings.test_tap_normal || tap_cosine > 0.01 - 1e-5;
    const bool may_lie_before = cosine > -1e-5;
    ambiguous |= (std::abs(cosine) < 1e-5 && may_face) ||
                 (std::abs(relative_square - 1.0) < 1e-5 && may_face && may_lie_before) ||
                 (settings.test_tap_normal && std::abs(tap_cosine - 0.01) < 1e-5 && may_lie_before);
    const bool far_hits = settings.test_tap_normal && settings.estimator == RadiosityEstimator::mara2016;
    if (cosine <= 0.0 || (settings.test_tap_normal && tap_cosine <= 0.01) || !(near || far_hits)) return {};
    const bool sends = near && layer < of.senders;
    return {
        sends ? cosine * falloff_of_square(falloff, relative_square) * vector_at(layers, layers.radiance[layer], source)
              : glm::dvec3(0.0),
        true};
}

inline Irradiance gathered_irradiance(const Layers& layers, const RadiositySettings& settings, Falloff falloff,
                                      Pixel pixel, GatheringLayers of = {}, const SpiralPattern& pattern = {}) {
    Irradiance result;
    const double depth = depth_at(layers, of.receiver, pixel);
    if (depth == 0.0) return result;
    const double projected = layers.view.pixels_per_metre() * settings.radius / depth;
    const std::vector<Tap> taps =
        spiral_taps(layers,
                    {.pixel = pixel,
                     .radius_pixels = settings.spread_pixels > 0 ? settings.spread_pixels : projected,
                     .samples = settings.samples,
                     .jitter = radiosity_jitter(settings, pixel, pattern),
                     .form = settings.pattern,
                     .use_mip_chain = settings.use_mip_chain,
                     .mip_offset = settings.mip_offset,
                     .minimum_mip_level = settings.minimum_mip_level,
                     .pattern = pattern},
                    result.ambiguous);
    const bool adds = settings.estimator == RadiosityEstimator::nielsen2015;
    glm::dvec3 sum{0.0};
    int hits = 0;
    for (const Tap& tap : taps) {
        if (!inside(layers, tap.pixel)) continue;
        glm::dvec3 best{0.0};
        int hits_of_tap = 0;
        for (int layer = 0; layer < settings.layers; ++layer) {
            const Received one = received_from(layers, settings, falloff, pixel, tap, layer, of, result.ambiguous);
            hits_of_tap += one.hit;
            if (adds) {
                sum += one.light;
            } else if (glm::dot(one.light, one.light) > glm::dot(best, best)) {
                best = one.light;
            }
        }
        sum += best;
        hits += adds ? hits_of_tap : std::min(hits_of_tap, 1);
    }
    const int all = adds ? settings.layers * settings.samples : settings.samples;
    const int divisor = settings.normalisation == RadiosityNormalisation::hits ? std::max(hits, 1) : all;
    result.irradiance = 2.0 * std::numbers::pi / divisor * sum;
    result.confidence = static_cast<double>(hits) / all;
    return result;
}

// How strongly indirect light is reflected over its saturation.
inline glm::dvec3 boosted(const RadiositySettings& settings, const glm::dvec3& light) {
    const double largest = std::max({light.x, light.y, light.z}), smallest = std::min({light.x, light.y, light.z});
    const double saturation = largest > 0.0 ? (largest - smallest) / largest : 0.0;
    return ((1.0 - saturation) * settings.unsaturated_boost + saturation * settings.saturated_boost) * light;
}

}  // namespace plumb::counterpart

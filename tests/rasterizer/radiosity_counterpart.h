// Screen-space radiosity on the CPU, from the formulas of rasterizer/radiosity.h.
#pragma once

#include "sample_spiral_counterpart.h"

namespace plumb::counterpart {

struct Irradiance {
    glm::dvec3 irradiance{0.0};
    double confidence = 0.0;
    bool ambiguous = false;
};

inline std::uint32_t radiosity_jitter(Pixel pixel) {
    std::uint32_t h =
        static_cast<std::uint32_t>(pixel.x) * 0x9E3779B1u ^ static_cast<std::uint32_t>(pixel.y) * 0x85EBCA77u;
    h = (h ^ (h >> 15)) * 0xC2B2AE3Du;
    h = (h ^ (h >> 13)) * 0x27D4EB2Fu;
    return 6554u + static_cast<std::uint32_t>(static_cast<std::uint64_t>(h >> 16) * 52428u / 65536u);  // 0.1 to 0.9
}

inline Irradiance gathered_irradiance(const Layers& layers, const RadiositySettings& settings, Falloff falloff,
                                      Pixel pixel) {
    Irradiance result;
    const double depth = depth_at(layers, 0, pixel);
    if (depth == 0.0) return result;
    const std::vector<Tap> taps =
        spiral_taps(layers,
                    {.pixel = pixel,
                     .radius_pixels = layers.view.pixels_per_metre() * settings.radius / depth,
                     .samples = settings.samples,
                     .jitter = radiosity_jitter(pixel),
                     .use_mip_chain = settings.use_mip_chain,
                     .mip_offset = settings.mip_offset,
                     .minimum_mip_level = settings.minimum_mip_level},
                    result.ambiguous);
    const glm::dvec3 centre = point_at(layers, 0, pixel), normal = vector_at(layers, layers.normal[0], pixel);
    glm::dvec3 sum{0.0};
    int hits = 0;
    for (const Tap& tap : taps) {
        if (!inside(layers, tap.pixel)) continue;
        glm::dvec3 best{0.0};
        bool hit = false;
        for (int layer = 0; layer < settings.layers; ++layer) {
            if (depth_at(layers, layer, tap.source) == 0.0) continue;
            if (layer == 0 && tap.source == pixel) continue;  // the shaded point itself has no direction
            const glm::dvec3 v = point_at(layers, layer, tap.source) - centre;
            const glm::dvec3 w = glm::normalize(v);
            const double cosine = glm::dot(w, normal),
                         relative_square = glm::dot(v, v) / (settings.radius * settings.radius);
            const double tap_cosine = -glm::dot(w, vector_at(layers, layers.normal[layer], tap.source));
            const bool near = relative_square < 1.0;
            // Rounding may decide whether the tap lies before the pixel, in reach, or turned towards it, unless another
            // answer settles the matter.
            const bool may_face = !settings.test_tap_normal || tap_cosine > 0.01 - 1e-5;
            const bool may_lie_before = cosine > -1e-5;
            result.ambiguous |= (std::abs(cosine) < 1e-5 && may_face) ||
                                (std::abs(relative_square - 1.0) < 1e-5 && may_face && may_lie_before) ||
                                (settings.test_tap_normal && std::abs(tap_cosine - 0.01) < 1e-5 && may_lie_before);
            if (cosine <= 0.0 || (settings.test_tap_normal ? tap_cosine <= 0.01 : !near)) continue;
            hit = true;
            const glm::dvec3 light = near ? cosine * falloff_of_square(falloff, relative_square) *
                                                vector_at(layers, layers.radiance[layer], tap.source)
                                          : glm::dvec3(0.0);
            if (glm::dot(light, light) > glm::dot(best, best)) best = light;
        }
        sum += best;
        hits += hit;
    }
    const int divisor = settings.normalisation == RadiosityNormalisation::hits ? std::max(hits, 1) : settings.samples;
    result.irradiance = 2.0 * std::numbers::pi / divisor * sum;
    result.confidence = static_cast<double>(hits) / settings.samples;
    return result;
}

}  // namespace plumb::counterpart

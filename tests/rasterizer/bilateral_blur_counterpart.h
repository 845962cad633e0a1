// One direction of the bilateral blur on the CPU, from the formulas of rasterizer/bilateral_blur.h.
#pragma once

#include "sample_spiral_counterpart.h"

namespace plumb::counterpart {

// What a key of some bits holds of a depth.
inline double depth_key(const Layers& layers, const BilateralBlurSettings& settings, double depth) {
    if (settings.depth_key_bits == 32) return depth;
    const double far_plane = layers.view.camera().far_plane, keys = std::pow(2.0, settings.depth_key_bits) - 1.0;
    return std::floor(std::min(depth / far_plane, 1.0) * keys + 0.5) * far_plane / keys;
}

inline double edge_weight(const Layers& layers, const BilateralBlurSettings& settings, double radius, Pixel centre,
                          Pixel tap) {
    const double depth = depth_at(layers, 0, tap);
    if (depth == 0.0) return 0.0;
    const glm::dvec3 v = point_at(layers, 0, tap) - point_at(layers, 0, centre);
    const glm::dvec3 n = vector_at(layers, layers.normal[0], centre), m = vector_at(layers, layers.normal[0], tap);
    const double off_plane = std::max(std::abs(glm::dot(v, n)), std::abs(glm::dot(v, m))) / glm::length(v);
    const bool exempt = glm::dot(v, v) < settings.plane_exemption;
    const double plane = exempt ? 1.0 : std::max(0.0, 1.0 - 2.0 * settings.plane_sharpness * off_plane);
    const double step =
        std::abs(depth_key(layers, settings, depth) - depth_key(layers, settings, depth_at(layers, 0, centre)));
    return std::max(0.0, 1.0 - settings.depth_sharpness * step / radius) *
           std::max(0.0, 1.0 - settings.normal_sharpness * (1.0 - glm::dot(n, m))) * plane * plane;
}

// Of a pixel `i` steps away, the centre's being 1. What G3D has in tables are normalised Gaussians, written out.
inline double weight_of_distance(const BilateralBlurSettings& settings, int i) {
    const auto gaussian = [](int distance, double sigma) {
        return std::exp(-0.5 * distance * distance / (sigma * sigma));
    };
    if (settings.weights == BlurWeights::gaussian) return gaussian(i, 0.5 * settings.radius);
    if (i == 0) return 1.0;
    if (settings.radius == 1) return (0.3 + 0.25) / 0.5;
    const int whole_radius = settings.radius <= 4 ? 4 : 6;
    const double sigma = settings.radius <= 4 ? 3.0 : 4.0;
    double sum = 1.0;
    for (int j = 1; j <= whole_radius; ++j) sum += 2.0 * gaussian(j, sigma);
    return 0.3 * sum + gaussian(i, sigma);
}

// Blurs `image` along (dx, dy), which is (1, 0) or (0, 1).
inline Image blurred(const Layers& layers, const BilateralBlurSettings& settings, double radius, const Image& image,
                     int dx, int dy) {
    Image result = image;
    for (int y = 0; y < layers.height(); ++y) {
        for (int x = 0; x < layers.width(); ++x) {
            if (depth_at(layers, 0, {x, y}) == 0.0) continue;
            for (int channel = 0; channel < image.channels(); ++channel) {
                const int row = layers.height() - 1 - y;
                double sum = image.at(x, row, channel), total = 1.0;
                for (const int side : {-1, 1}) {
                    double smallest = 1.0;
                    for (int i = 1; i <= settings.radius; ++i) {
                        const Pixel tap{x + side * i * settings.step * dx, y + side * i * settings.step * dy};
                        double edge = inside(layers, tap) ? edge_weight(layers, settings, radius, {x, y}, tap) : 0.0;
                        if (settings.monotonic) edge = smallest = std::min(smallest, edge);
                        if (edge == 0.0) continue;
                        const double weight = edge * weight_of_distance(settings, i);
                        sum += weight * image.at(tap.x, layers.height() - 1 - tap.y, channel);
                        total += weight;
                    }
                }
                result.at(x, row, channel) = static_cast<float>(sum / total);
            }
        }
    }
    return result;
}

}  // namespace plumb::counterpart

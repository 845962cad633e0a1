// One direction of the depth-aware Gaussian blur on the CPU, from Nielsen's thesis (2015, section 2.5).
#pragma once

#include "sample_spiral_counterpart.h"

namespace plumb::counterpart {

// What a depth buffer of the standard mapping holds, from the projection matrix: (a z + b) / -z at camera-space z.
inline double depth_buffer_value(const Camera& camera, double depth) {
    const double near_plane = camera.near_plane, far_plane = camera.far_plane;
    const double a = -far_plane / (far_plane - near_plane), b = -near_plane * far_plane / (far_plane - near_plane);
    return (a * -depth + b) / depth;
}

// Blurs `image` along (dx, dy), which is (1, 0) or (0, 1). As the thesis, the sums run over all taps with the centre.
inline Image gaussian_blurred(const Layers& layers, const BilateralBlurSettings& settings, const Image& image, int dx,
                              int dy) {
    Image result = image;
    const double sigma = settings.radius / 3.0;
    for (int y = 0; y < layers.height(); ++y) {
        for (int x = 0; x < layers.width(); ++x) {
            const double depth = depth_at(layers, 0, {x, y});
            if (depth == 0.0) continue;
            for (int channel = 0; channel < image.channels(); ++channel) {
                double sum = 0.0, total = 0.0;
                for (int i = -settings.radius; i <= settings.radius; ++i) {
                    const Pixel tap{x + i * settings.step * dx, y + i * settings.step * dy};
                    if (!inside(layers, tap) || depth_at(layers, 0, tap) == 0.0) continue;
                    const Camera& camera = layers.view.camera();
                    const double difference = std::abs(depth_buffer_value(camera, depth_at(layers, 0, tap)) -
                                                       depth_buffer_value(camera, depth));
                    const bool listing = settings.kind == BlurKind::gaussian_2015_listing;
                    const double weight = std::exp(-i * i / (2.0 * sigma * sigma)) *
                                          std::max(0.0, 1.0 - (listing ? std::sqrt(difference) : difference));
                    sum += weight * image.at(tap.x, layers.height() - 1 - tap.y, channel);
                    total += weight;
                }
                result.at(x, layers.height() - 1 - y, channel) = static_cast<float>(sum / total);
            }
        }
    }
    return result;
}

}  // namespace plumb::counterpart

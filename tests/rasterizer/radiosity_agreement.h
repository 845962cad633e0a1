// Holds gathered irradiance and confidence against the counterpart, pixel by pixel.
#pragma once

#include <gtest/gtest.h>

#include "radiosity_counterpart.h"
#include "screen_space_run.h"

namespace plumb {

inline Method unblurred(RadiositySettings radiosity) {
    radiosity.blur.radius = 0;
    Method method;
    method.radiosity = radiosity;
    return method;
}

// `irradiance` holds the confidence as its fourth channel, or `confidence` does. Returns the share of pixels that
// rounding leaves open.
inline double expect_agreement(const counterpart::Layers& layers, const RadiositySettings& settings,
                               const Image& irradiance, const Image& confidence, Falloff falloff = Falloff::hard,
                               counterpart::GatheringLayers of = {}, const counterpart::SpiralPattern& pattern = {}) {
    const int width = layers.width(), height = layers.height();
    const int confidence_channel = confidence.channels() - 1;
    int ambiguous = 0, wrong = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const counterpart::Irradiance expected =
                counterpart::gathered_irradiance(layers, settings, falloff, {x, y}, of, pattern);
            ambiguous += expected.ambiguous;
            if (expected.ambiguous) continue;
            const int row = height - 1 - y;
            // A ratio of small integers.
            bool right = std::abs(confidence.at(x, row, confidence_channel) - expected.confidence) < 1e-6;
            for (int c = 0; c < 3; ++c) {
                // Float positions 4 m away are good to 1e-6 m, so that the cosine to a tap some millimetres away is
                // good to a few 1e-4; E is at most 2 pi.
                right = right && std::abs(irradiance.at(x, row, c) - expected.irradiance[c]) < 1e-3;
            }
            if (!right && ++wrong < 5) {
                ADD_FAILURE() << "pixel (" << x << ", " << y << ") from the bottom left: irradiance "
                              << irradiance.at(x, row, 0) << ", confidence "
                              << confidence.at(x, row, confidence_channel) << "; expected " << expected.irradiance[0]
                              << " and " << expected.confidence;
            }
        }
    }
    EXPECT_EQ(wrong, 0);
    return static_cast<double>(ambiguous) / (width * height);
}

}  // namespace plumb

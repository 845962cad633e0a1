// What the tests of reflections share: methods, requests of the counterpart, and a room to reflect.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "reflection_run.h"
#include "screen_space_run.h"

namespace plumb {

inline const Quantities reflection_alone = {.planes = {"reflection"}};
constexpr float reflected_separation = 0.1f;

inline Method method_of(ReflectionSettings settings) {
    settings.enabled = true;
    Method method;
    method.gbuffer.minimum_separation = reflected_separation;
    method.reflections = settings;
    return method;
}

inline counterpart::ReflectionRequest request_of(ReflectionSettings settings,
                                                 const Quantities& quantities = reflection_alone,
                                                 const glm::vec3& sky = glm::vec3(0.0f)) {
    if (settings.thickness == 0.0f) settings.thickness = reflected_separation;
    counterpart::ReflectionRequest request;
    request.settings = settings;
    request.radius = quantities.reflection_radius;
    request.falloff = quantities.reflection_falloff;
    if (settings.fallback != ReflectionFallback::none)
        request.fallback = [sky](const glm::dvec3&, double) { return glm::dvec3(sky); };
    return request;
}

// Of these pixels only: the others cost nothing.
inline counterpart::Gloss gloss_at(const std::vector<counterpart::Pixel>& pixels, counterpart::Gloss gloss) {
    for (int y = 0; y < gloss.f0.height(); ++y) {
        for (int x = 0; x < gloss.f0.width(); ++x) {
            const counterpart::Pixel pixel{x, gloss.f0.height() - 1 - y};
            if (std::ranges::find(pixels, pixel) != pixels.end()) continue;
            for (int c = 0; c < 3; ++c) gloss.f0.at(x, y, c) = 0.0f;
            gloss.f90.at(x, y) = 0.0f;
        }
    }
    return gloss;
}

// A floor, a wall of many colours behind it and, between the two, a low table in front of which hangs a board.
inline counterpart::Layers reflected_room(const View& view) {
    counterpart::Layers layers =
        layers_of_patches(view, {{{-4.0f, -1.0f, -7.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 8.0f}},
                                 {{-4.0f, -1.0f, -6.0f}, {8.0f, 0.0f, 0.5f}, {0.0f, 6.0f, 0.3f}},
                                 {{-0.8f, -0.5f, -5.5f}, {1.6f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f}},
                                 {{-0.6f, -0.9f, -3.0f}, {1.0f, 0.0f, 0.2f}, {0.0f, 0.6f, 0.1f}}});
    for (int layer = 0; layer < 2; ++layer) {
        for (int y = 0; y < view.height(); ++y) {
            for (int x = 0; x < view.width(); ++x) {
                const double depth = layers.depth[layer].at(x, y);
                layers.radiance[layer].at(x, y, 0) = static_cast<float>(0.5 + 0.4 * std::sin(3.0 * depth));
                layers.radiance[layer].at(x, y, 1) = 0.1f + 0.8f * static_cast<float>(y) / view.height();
                layers.radiance[layer].at(x, y, 2) = 0.5f * static_cast<float>(layer);
            }
        }
    }
    return layers;
}

}  // namespace plumb

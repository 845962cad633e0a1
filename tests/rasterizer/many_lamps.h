// Scenes of any number of lamps.
#pragma once

#include <cmath>

#include "scenes/scene.h"

namespace plumb {

// Spreads `count` point lights evenly through the scene's box, each of which reaches (at a threshold of 1/256 W / m^2)
// as far as eight lamps' share of the volume would: the more there are, the smaller each is. Every fourth is a spot
// light that shines downwards, where `spots` are wanted.
inline void add_lamps(Scene& scene, int count, bool spots = false) {
    const Bounds box = scene.bounds();
    const glm::vec3 size = box.upper - box.lower;
    const float radius = 2.0f * std::cbrt(size.x * size.y * size.z / static_cast<float>(count) * 0.2387f);
    const float intensity = radius * radius / 256.0f;
    for (int i = 0; i < count; ++i) {
        // Roberts' R3 sequence: low discrepancy, and the first lamps of many are those of few.
        const auto part = [i](double step) { return static_cast<float>(std::fmod(0.5 + step * (i + 1), 1.0)); };
        const glm::vec3 at(part(0.8191725133961645), part(0.6710436067037893), part(0.5497004779019703));
        const glm::vec3 colour(0.5f + 0.5f * at.y, 0.5f + 0.5f * at.z, 0.5f + 0.5f * at.x);
        const glm::vec3 position = box.lower + (0.05f + 0.9f * at) * size;
        if (spots && i % 4 == 3) {
            scene.spot_lights.push_back({"spot", position, {0, -1, 0}, intensity * colour, 0.4f, 0.4f + 0.3f * at.x});
        } else {
            scene.point_lights.push_back({"lamp", position, intensity * colour});
        }
    }
}

}  // namespace plumb

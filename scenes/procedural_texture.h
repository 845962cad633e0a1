// Textures for scenes made by code: seeded, seamless where they repeat, of low frequency, so that a bilinear lookup in
// level 0 is a fair one.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>

#include <glm/glm.hpp>

#include "scenes/texture.h"

namespace plumb {

// Uniform numbers that are the same on every standard library (whose distributions differ; its engines do not).
class Random {
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    float uniform() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }
    float uniform(float low, float high) { return low + (high - low) * uniform(); }

private:
    std::mt19937 engine_;
};

// A square texture, `colour_and_alpha` evaluated at each texel's centre.
Texture make_texture(std::string name, int size, const std::function<glm::vec4(glm::vec2 uv)>& colour_and_alpha,
                     TextureWrap wrap = TextureWrap::repeat);

// Smooth noise in about [0, 1] that repeats over the unit square; `cells` lattice cells across, three octaves.
class PeriodicNoise {
public:
    PeriodicNoise(int cells, std::uint32_t seed);
    float operator()(glm::vec2 uv) const;

private:
    float octave(glm::vec2 uv, int cells) const;
    int cells_;
    std::vector<float> lattice_;
};

}  // namespace plumb

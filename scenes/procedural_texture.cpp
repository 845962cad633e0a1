#include "scenes/procedural_texture.h"

#include <cmath>
#include <utility>

namespace plumb {

Texture make_texture(std::string name, int size, const std::function<glm::vec4(glm::vec2 uv)>& colour_and_alpha,
                     TextureWrap wrap) {
    Texture texture;
    texture.name = std::move(name);
    texture.width = texture.height = size;
    texture.wrap_u = texture.wrap_v = wrap;
    texture.texels.reserve(4 * static_cast<std::size_t>(size) * size);
    for (int j = 0; j < size; ++j) {
        for (int i = 0; i < size; ++i) {
            const glm::vec4 texel = colour_and_alpha((glm::vec2(i, j) + 0.5f) / static_cast<float>(size));
            for (int channel = 0; channel < 4; ++channel) texture.texels.push_back(half(texel[channel]));
        }
    }
    return texture;
}

namespace {
constexpr int lattice_size = 64;  // per side; cells wrap at multiples of `cells`, well below it
}

PeriodicNoise::PeriodicNoise(int cells, std::uint32_t seed)
    : cells_(cells), lattice_(static_cast<std::size_t>(lattice_size) * lattice_size) {
    Random random(seed);
    for (float& value : lattice_) value = random.uniform();
}

float PeriodicNoise::octave(glm::vec2 uv, int cells) const {
    const glm::vec2 p = uv * static_cast<float>(cells);
    const glm::vec2 cell = glm::floor(p);
    const glm::vec2 t = p - cell, s = t * t * (3.0f - 2.0f * t);
    const auto value = [&](int i, int j) {
        const int x = ((static_cast<int>(cell.x) + i) % cells + cells) % cells;
        const int y = ((static_cast<int>(cell.y) + j) % cells + cells) % cells;
        return lattice_[(y % lattice_size) * lattice_size + x % lattice_size];
    };
    return glm::mix(glm::mix(value(0, 0), value(1, 0), s.x), glm::mix(value(0, 1), value(1, 1), s.x), s.y);
}

float PeriodicNoise::operator()(glm::vec2 uv) const {
    return (4.0f * octave(uv, cells_) + 2.0f * octave(uv, 2 * cells_) + octave(uv, 4 * cells_)) / 7.0f;
}

}  // namespace plumb

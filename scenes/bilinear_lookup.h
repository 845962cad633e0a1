// Which four texels a bilinear look-up of a texture reads, and how it mixes them.
#pragma once

#include <cmath>

#include <glm/glm.hpp>

#include "scenes/texture.h"

namespace plumb {

// Texel centres at (i + 0.5) / size, as OpenGL's GL_LINEAR.
struct BilinearLookup {
    int x0, x1, y0, y1;
    float right, lower;  // shares of x1 and y1

    BilinearLookup(const Texture& texture, const glm::vec2& uv) {
        const float x = to_texel(uv.x, texture.width, texture.wrap_u);
        const float y = to_texel(uv.y, texture.height, texture.wrap_v);
        const float x_floor = std::floor(x), y_floor = std::floor(y);
        right = x - x_floor, lower = y - y_floor;
        const int column = static_cast<int>(x_floor), row = static_cast<int>(y_floor);
        x0 = wrapped(column, texture.width, texture.wrap_u), x1 = wrapped(column + 1, texture.width, texture.wrap_u);
        y0 = wrapped(row, texture.height, texture.wrap_v), y1 = wrapped(row + 1, texture.height, texture.wrap_v);
    }

    // Four channels at once, for this runs for every hit.
    using Rgba [[gnu::vector_size(16)]] = float;

    // `texel(x, y)` is an Rgba.
    template <typename Texel>
    glm::vec4 mix(const Texel& texel) const {
        return mix(right, lower, [&](int column, int row) { return texel(column ? x1 : x0, row ? y1 : y0); });
    }
    // `texel(column, row)` is the Rgba of one of the four, 0 or 1 each.
    template <typename Texel>
    static glm::vec4 mix(float right, float lower, const Texel& texel) {
        const auto mixed = [](Rgba from, Rgba to, float share) { return from * (1.0f - share) + to * share; };
        const Rgba value = mixed(mixed(texel(0, 0), texel(1, 0), right), mixed(texel(0, 1), texel(1, 1), right), lower);
        return {value[0], value[1], value[2], value[3]};
    }

private:
    // Whole turns are taken off first, in float, so that large coordinates keep their fraction and never overflow int.
    static float to_texel(float t, int size, TextureWrap wrap) {
        if (wrap == TextureWrap::repeat) t -= std::floor(t);
        if (wrap == TextureWrap::mirror) t -= 2.0f * std::floor(0.5f * t);
        if (wrap == TextureWrap::clamp) t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
        return t * static_cast<float>(size) - 0.5f;
    }
    // `i` at most one period outside: comparisons instead of divisions.
    static int wrapped(int i, int size, TextureWrap wrap) {
        switch (wrap) {
            case TextureWrap::clamp:
                return i < 0 ? 0 : i >= size ? size - 1 : i;
            case TextureWrap::mirror:
                i = i < 0 ? i + 2 * size : i >= 2 * size ? i - 2 * size : i;
                return i < size ? i : 2 * size - 1 - i;
            case TextureWrap::repeat:
                break;
        }
        return i < 0 ? i + size : i >= size ? i - size : i;
    }
};

}  // namespace plumb

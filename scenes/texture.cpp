#include "scenes/texture.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#ifdef __F16C__
#include <immintrin.h>
#endif

namespace plumb {
namespace {

// `i` at most one period outside, as `sample` leaves it: comparisons instead of divisions, as this runs for every hit.
int wrapped(int i, int size, TextureWrap wrap) {
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

// Four channels at once, for this runs for every hit.
using Rgba [[gnu::vector_size(16)]] = float;

Rgba rgba(const half* texel) {
#ifdef __F16C__
    return _mm_cvtph_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(texel)));
#else
    return Rgba{texel[0], texel[1], texel[2], texel[3]};
#endif
}

Rgba rgba(const float* texel) {
    Rgba value;
    std::memcpy(&value, texel, sizeof value);
    return value;
}

}  // namespace

glm::vec4 Texture::sample(glm::vec2 uv) const {
    // Whole turns are taken off first, in float, so that large coordinates keep their fraction and never overflow int.
    const auto to_texel = [](float t, int size, TextureWrap wrap) {
        if (wrap == TextureWrap::repeat) t -= std::floor(t);
        if (wrap == TextureWrap::mirror) t -= 2.0f * std::floor(0.5f * t);
        if (wrap == TextureWrap::clamp) t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
        return t * static_cast<float>(size) - 0.5f;
    };
    const float x = to_texel(uv.x, width, wrap_u), y = to_texel(uv.y, height, wrap_v);
    const float x_floor = std::floor(x), y_floor = std::floor(y);
    const float fx = x - x_floor, fy = y - y_floor;
    const int x0 = wrapped(static_cast<int>(x_floor), width, wrap_u);
    const int x1 = wrapped(static_cast<int>(x_floor) + 1, width, wrap_u);
    const int y0 = wrapped(static_cast<int>(y_floor), height, wrap_v);
    const int y1 = wrapped(static_cast<int>(y_floor) + 1, height, wrap_v);
    const auto mixed = [](Rgba from, Rgba to, float share) { return from * (1.0f - share) + to * share; };
    const auto bilinear = [&](const auto* values) {
        const auto texel = [&](int i, int j) { return rgba(&values[4 * (static_cast<std::size_t>(j) * width + i)]); };
        return mixed(mixed(texel(x0, y0), texel(x1, y0), fx), mixed(texel(x0, y1), texel(x1, y1), fx), fy);
    };
    const Rgba value = is_wide() ? bilinear(wide_texels.data()) : bilinear(texels.data());
    return {value[0], value[1], value[2], value[3]};
}

float Texture::brightest() const {
    float largest = 0.0f;
    for (std::size_t i = 0; i < value_count(); ++i) {
        if (i % 4 != 3) largest = std::max(largest, value(i));
    }
    return largest;
}

}  // namespace plumb

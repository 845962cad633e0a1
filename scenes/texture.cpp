#include "scenes/texture.h"

#include <algorithm>
#include <cstring>

#include "scenes/bilinear_lookup.h"

#ifdef __F16C__
#include <immintrin.h>
#endif

namespace plumb {
namespace {

using Rgba = BilinearLookup::Rgba;

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
    const BilinearLookup lookup(*this, uv);
    const auto mix = [&](const auto* values) {
        return lookup.mix([&](int x, int y) { return rgba(&values[4 * (static_cast<std::size_t>(y) * width + x)]); });
    };
    return is_wide() ? mix(wide_texels.data()) : mix(texels.data());
}

float Texture::brightest() const {
    float largest = 0.0f;
    for (std::size_t i = 0; i < value_count(); ++i) {
        if (i % 4 != 3) largest = std::max(largest, value(i));
    }
    return largest;
}

}  // namespace plumb

// A texture as both renderers read it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Imath/half.h>
#include <glm/glm.hpp>

namespace plumb {

enum class TextureWrap { repeat, clamp, mirror };

constexpr float largest_half = 65504.0f;

// Linear RGBA texels, row-major, first row at v = 0 (as glTF: v grows downwards in the picture), in half floats: they
// keep 8-bit sRGB input exactly distinguishable and are the same bits on the CPU and in OpenGL. Where a value exceeds
// them, as a sun does in a picture of the sky, all are 32-bit floats instead: nothing is cut.
struct Texture {
    std::string name;
    int width = 0, height = 0;
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
    std::vector<half> texels;        // 4 * width * height
    std::vector<float> wide_texels;  // the same number instead of `texels`, or empty

    bool is_wide() const { return !wide_texels.empty(); }
    std::size_t value_count() const { return is_wide() ? wide_texels.size() : texels.size(); }
    float value(std::size_t i) const { return is_wide() ? wide_texels[i] : static_cast<float>(texels[i]); }
    float brightest() const;  // of red, green and blue, over all texels; at least 0

    // Bilinear lookup in level 0; texel centres at (i + 0.5) / size, as OpenGL's GL_LINEAR.
    glm::vec4 sample(glm::vec2 uv) const;
};

}  // namespace plumb

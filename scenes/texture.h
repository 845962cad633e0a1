// A texture as both renderers read it.
#pragma once

#include <string>
#include <vector>

#include <Imath/half.h>
#include <glm/glm.hpp>

namespace plumb {

enum class TextureWrap { repeat, clamp, mirror };

// Linear RGBA texels in half floats, row-major, first row at v = 0 (as glTF: v grows downwards in the picture). Half
// floats keep 8-bit sRGB input exactly distinguishable and are the same bits on the CPU and in OpenGL.
struct Texture {
    std::string name;
    int width = 0, height = 0;
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
    std::vector<half> texels;  // 4 * width * height

    // Bilinear lookup in level 0; texel centres at (i + 0.5) / size, as OpenGL's GL_LINEAR.
    glm::vec4 sample(glm::vec2 uv) const;
};

}  // namespace plumb

#include "pathtracer/packed_textures.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// As many different values per channel as `levels`, the alpha's others than the colours'.
Texture random_texture(int width, int height, int levels, TextureWrap wrap_u, TextureWrap wrap_v, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> level(0, levels - 1);
    Texture texture;
    texture.width = width, texture.height = height;
    texture.wrap_u = wrap_u, texture.wrap_v = wrap_v;
    for (int i = 0; i < width * height; ++i) {
        for (int c = 0; c < 3; ++c) {
            texture.texels.emplace_back(std::pow(static_cast<float>(level(random)) / static_cast<float>(levels), 2.2f));
        }
        texture.texels.emplace_back(static_cast<float>(level(random)) / static_cast<float>(levels));
    }
    return texture;
}

// Near, inside and several turns outside, on the texels' borders too.
std::vector<glm::vec2> places(const Texture& texture, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> inside(0.0f, 1.0f), anywhere(-4.0f, 5.0f);
    std::vector<glm::vec2> places;
    for (int i = 0; i < 2000; ++i) {
        places.emplace_back(inside(random), inside(random)), places.emplace_back(anywhere(random), anywhere(random));
    }
    for (int y = -1; y <= 2 * texture.height + 1; ++y) {
        for (int x = -1; x <= 2 * texture.width + 1; ++x) {
            places.emplace_back(0.5f * static_cast<float>(x) / static_cast<float>(texture.width),
                                0.5f * static_cast<float>(y) / static_cast<float>(texture.height));
        }
    }
    return places;
}

// The sums are the same, but a compiler may leave out the rounding of a product before a sum: that of uv * size moves
// both shares by half a unit in the last place of the size, the others' are some units of values up to 1.
void expect_same_samples(const PackedTextures& packed, int index, const Texture& texture) {
    const float tolerance = 0x1p-23f * static_cast<float>(std::max(texture.width, texture.height)) + 4 * 0x1p-24f;
    for (const glm::vec2& uv : places(texture, 7)) {
        const glm::vec4 expected = texture.sample(uv), found = packed.sample(index, uv);
        for (int c = 0; c < 4; ++c) {
            ASSERT_NEAR(found[c], expected[c], tolerance)
                << "texture " << index << ", channel " << c << " at (" << uv.x << ", " << uv.y << ")";
        }
    }
}

TEST(PackedTextures, AreTheTexturesAtEveryPlace) {
    // Whole tiles, parts of tiles, less than one; every way to wrap.
    const std::vector<Texture> textures = {
        random_texture(16, 8, 256, TextureWrap::repeat, TextureWrap::repeat, 1),
        random_texture(13, 7, 256, TextureWrap::clamp, TextureWrap::mirror, 2),
        random_texture(3, 5, 100, TextureWrap::mirror, TextureWrap::clamp, 3),
        random_texture(1, 1, 2, TextureWrap::repeat, TextureWrap::clamp, 4),
    };
    const PackedTextures packed(textures);
    for (int i = 0; i < static_cast<int>(textures.size()); ++i) {
        EXPECT_TRUE(packed.is_packed(i)) << "texture " << i;
        expect_same_samples(packed, i, textures[i]);
    }
}

TEST(PackedTextures, TexelsThemselvesKeepTheirBits) {
    const std::vector<Texture> textures = {random_texture(13, 7, 256, TextureWrap::repeat, TextureWrap::repeat, 5)};
    const PackedTextures packed(textures);
    const Texture& texture = textures[0];
    for (int y = 0; y < texture.height; ++y) {
        for (int x = 0; x < texture.width; ++x) {
            // Right on a centre up to the rounding of its coordinate, which the next texel's share is.
            const glm::vec2 uv((static_cast<float>(x) + 0.5f) / 13.0f, (static_cast<float>(y) + 0.5f) / 7.0f);
            for (int c = 0; c < 4; ++c) {
                EXPECT_NEAR(packed.sample(0, uv)[c], texture.value(4 * static_cast<std::size_t>(13 * y + x) + c), 2e-6f)
                    << "texel (" << x << ", " << y << "), channel " << c;
            }
        }
    }
}

// Pictures of 16 bits or floats have more values than a byte can tell; the others are packed all the same.
TEST(PackedTextures, WhatHasTooManyValuesIsReadAsItIs) {
    std::vector<Texture> textures = {
        random_texture(40, 30, 1000, TextureWrap::repeat, TextureWrap::repeat, 6),
        random_texture(12, 12, 200, TextureWrap::repeat, TextureWrap::repeat, 7),
        random_texture(12, 12, 2, TextureWrap::repeat, TextureWrap::repeat, 8),
    };
    textures[2].wide_texels.assign(textures[2].texels.begin(), textures[2].texels.end());
    textures[2].texels.clear();
    const PackedTextures packed(textures);
    EXPECT_FALSE(packed.is_packed(0));
    EXPECT_TRUE(packed.is_packed(1));
    EXPECT_FALSE(packed.is_packed(2));
    for (int i = 0; i < 3; ++i) expect_same_samples(packed, i, textures[i]);
}

// Many lanes, some of a packed texture, some of another one, some of none: those keep what they have.
TEST(PackedTextures, LanesGetWhatEachGetsAlone) {
    const std::vector<Texture> textures = {
        random_texture(16, 8, 256, TextureWrap::repeat, TextureWrap::mirror, 9),
        random_texture(40, 30, 1000, TextureWrap::clamp, TextureWrap::repeat, 10),
        random_texture(13, 7, 150, TextureWrap::mirror, TextureWrap::clamp, 11),
    };
    const PackedTextures packed(textures);
    std::mt19937 random(12);
    std::uniform_int_distribution<int> any(-1, 2);
    static_assert(no_texture == -1);
    std::uniform_real_distribution<float> anywhere(-4.0f, 5.0f);
    const glm::vec3 before(-1.0f, -2.0f, -3.0f);
    for (const int count : {0, 1, 77, most_lanes}) {
        Lanes<int> texture;
        Lanes<float> u, v;
        VectorLanes colour;
        colour.fill(0, most_lanes, before);
        for (int i = 0; i < most_lanes; ++i) texture[i] = any(random), u[i] = anywhere(random), v[i] = anywhere(random);
        packed.sample(texture, u, v, count, colour);
        for (int i = 0; i < most_lanes; ++i) {
            const bool is_asked = i < count && texture[i] != no_texture;
            const glm::vec3 expected = is_asked ? glm::vec3(packed.sample(texture[i], {u[i], v[i]})) : before;
            EXPECT_EQ(colour.get(i), expected) << "lane " << i << " of " << count << ", texture " << texture[i];
        }
    }
}

// Tables of values are shared while they have room: 150 and 150 others need two.
TEST(PackedTextures, WithOtherValuesEachDoNotDisturbEachOther) {
    std::vector<Texture> textures;
    for (int levels = 150; levels < 158; ++levels) {
        textures.push_back(random_texture(24, 24, levels, TextureWrap::repeat, TextureWrap::repeat, levels));
    }
    const PackedTextures packed(textures);
    for (int i = 0; i < static_cast<int>(textures.size()); ++i) {
        EXPECT_TRUE(packed.is_packed(i)) << "texture " << i;
        expect_same_samples(packed, i, textures[i]);
    }
}

}  // namespace
}  // namespace plumb

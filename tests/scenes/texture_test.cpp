#include "scenes/texture.h"

#include <gtest/gtest.h>

#include "scenes/light.h"
#include "scenes/texture_file.h"

namespace plumb {
namespace {

// Four texels in a row, red = 1, 2, 3, 4; two equal rows below each other with green = 0 and 8.
Texture ramp(TextureWrap wrap) {
    Texture texture;
    texture.width = 4;
    texture.height = 2;
    texture.wrap_u = texture.wrap_v = wrap;
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 4; ++i) {
            for (const float value : {i + 1.0f, 8.0f * j, 0.0f, 1.0f}) texture.texels.push_back(half(value));
        }
    }
    return texture;
}

struct Lookup {
    float u;
    float red;  // worked out by hand: texel centres lie at 1/8, 3/8, 5/8, 7/8
};

void expect_red(TextureWrap wrap, std::initializer_list<Lookup> lookups) {
    const Texture texture = ramp(wrap);
    for (const Lookup& lookup : lookups) {
        // 1e-5: u is rounded to float before it is multiplied by the size.
        EXPECT_NEAR(texture.sample({lookup.u, 0.25f}).x, lookup.red, 1e-5f) << "u = " << lookup.u;
    }
}

TEST(Texture, RepeatsBilinearly) {
    expect_red(TextureWrap::repeat, {{0.125f, 1.0f},
                                     {0.25f, 1.5f},
                                     {0.5f, 2.5f},
                                     {0.0f, 2.5f},
                                     {1.0f, 2.5f},
                                     {1.25f, 1.5f},
                                     {-0.75f, 1.5f},
                                     {-0.0625f, 3.25f}});
}

TEST(Texture, ClampsBilinearly) {
    expect_red(TextureWrap::clamp,
               {{0.0f, 1.0f}, {-3.0f, 1.0f}, {0.25f, 1.5f}, {1.0f, 4.0f}, {7.0f, 4.0f}, {0.8125f, 3.75f}});
}

TEST(Texture, MirrorsBilinearly) {
    expect_red(
        TextureWrap::mirror,
        {{0.0f, 1.0f}, {-0.25f, 1.5f}, {0.25f, 1.5f}, {1.0f, 4.0f}, {1.25f, 3.5f}, {2.25f, 1.5f}, {-1.0f, 4.0f}});
}

TEST(Texture, FirstRowIsAtVZero) {
    const Texture texture = ramp(TextureWrap::clamp);
    EXPECT_FLOAT_EQ(texture.sample({0.5f, 0.0f}).y, 0.0f);
    EXPECT_FLOAT_EQ(texture.sample({0.5f, 1.0f}).y, 8.0f);
    EXPECT_FLOAT_EQ(texture.sample({0.5f, 0.5f}).y, 4.0f);
}

TEST(Texture, HugeCoordinatesStayInside) {
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::clamp, TextureWrap::mirror}) {
        const Texture texture = ramp(wrap);
        for (const float u : {1e9f, -1e9f, 3e38f}) {
            const float red = texture.sample({u, u}).x;
            EXPECT_GE(red, 1.0f);
            EXPECT_LE(red, 4.0f);
        }
    }
}

TEST(Texture, SrgbBecomesLinear) {
    EXPECT_FLOAT_EQ(linear_from_srgb(0.0f), 0.0f);
    EXPECT_FLOAT_EQ(linear_from_srgb(1.0f), 1.0f);
    EXPECT_NEAR(linear_from_srgb(0.5f), 0.21404114f, 1e-6f);  // IEC 61966-2-1
}

TEST(Texture, FlippingRowsTwiceChangesNothing) {
    Texture texture = ramp(TextureWrap::clamp);
    flip_rows(texture);
    EXPECT_FLOAT_EQ(texture.sample({0.5f, 0.0f}).y, 8.0f);
    flip_rows(texture);
    EXPECT_FLOAT_EQ(texture.sample({0.5f, 0.0f}).y, 0.0f);
}

TEST(Environment, StraightUpIsTheFirstRowAndMinusZTheMiddle) {
    const Environment environment;
    EXPECT_NEAR(environment.texture_coordinates({0, 1, 0}).y, 0.0f, 1e-6f);
    EXPECT_NEAR(environment.texture_coordinates({0, -1, 0}).y, 1.0f, 1e-6f);
    EXPECT_NEAR(environment.texture_coordinates({0, 0, -1}).x, 0.5f, 1e-6f);
    EXPECT_NEAR(environment.texture_coordinates({1, 0, 0}).x, 0.75f, 1e-6f);
}

}  // namespace
}  // namespace plumb

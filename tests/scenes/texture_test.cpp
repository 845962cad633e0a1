#include "scenes/texture.h"

#include <cmath>
#include <limits>

#include <glm/gtc/constants.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/light.h"
#include "scenes/scene_error.h"
#include "scenes/texture_file.h"
#include "tests/bright_sky.h"
#include "tests/message_of.h"

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

TEST(Texture, KeepsASunThatIsBrighterThanHalfFloatsHold) {
    for (const std::string extension : {"exr", "hdr"}) {
        const TemporaryFolder folder;
        const auto file = folder / ("sky." + extension);
        write_float_picture(file, sky_columns, sky_rows, bright_sky());
        Texture sky = load_texture(file, TextureContent::colour);
        const auto at_texel = [&](int column, int row) {
            return sky.sample(
                {(static_cast<float>(column) + 0.5f) / sky_columns, (static_cast<float>(row) + 0.5f) / sky_rows});
        };
        EXPECT_EQ(at_texel(sun_column, sun_row), glm::vec4(sun_radiance, sun_radiance, sun_radiance, 1.0f));
        EXPECT_EQ(at_texel(0, 0), glm::vec4(clear_sky_radiance, clear_sky_radiance, clear_sky_radiance, 1.0f));
        EXPECT_EQ(sky.brightest(), sun_radiance);
        flip_rows(sky);
        EXPECT_EQ(at_texel(sun_column, sky_rows - 1 - sun_row).x, sun_radiance);
        const Scene scene = floor_below_bright_sky(extension);
        // 1e-3: a float's worth of the direction moves the lookup by 1e-6 of the picture, past texels a million apart.
        EXPECT_NEAR(scene.environment_radiance(sun_direction(scene)).y, sun_radiance, 1e-3f * sun_radiance);
        EXPECT_EQ(scene.brightest_emission(), sun_radiance);
    }
}

TEST(Texture, OfFloatsThatHalfFloatsHoldStaysSmall) {
    const TemporaryFolder folder;
    write_float_picture(folder / "dim.exr", 1, 1, {largest_half, 0.5f, 0.0f});
    const Texture dim = load_texture(folder / "dim.exr", TextureContent::colour);
    EXPECT_FALSE(dim.is_wide());
    EXPECT_EQ(dim.sample({0.5f, 0.5f}), glm::vec4(largest_half, 0.5f, 0.0f, 1.0f));
}

TEST(Texture, RefusesWhatIsNoRadianceAndSaysWhereAndWhatToDo) {
    constexpr float infinite = std::numeric_limits<float>::infinity();
    for (const float bad : {infinite, std::nanf(""), -0.5f}) {
        const TemporaryFolder folder;
        std::vector<float> values(std::size_t{3} * 4 * 2, 1.0f);
        values[3 * 6 + 1] = bad;
        write_float_picture(folder / "sky.exr", 4, 2, values);
        EXPECT_THAT(message_of<SceneError>([&] { load_texture(folder / "sky.exr", TextureContent::colour); }),
                    testing::AllOf(testing::HasSubstr((folder / "sky.exr").string()),
                                   testing::HasSubstr("channel 1 of pixel (2, 1)"),
                                   testing::HasSubstr("finite and not negative"), testing::HasSubstr("oiiotool")));
    }
    const TemporaryFolder folder;
    write_float_picture(folder / "data.exr", 1, 1, {-0.5f, 0.0f, 1.0f});
    EXPECT_EQ(load_texture(folder / "data.exr", TextureContent::data).sample({0.5f, 0.5f}).x, -0.5f);
}

TEST(Environment, StraightUpIsTheFirstRowAndMinusZTheMiddle) {
    const Environment environment;
    EXPECT_NEAR(environment.texture_coordinates({0, 1, 0}).y, 0.0f, 1e-6f);
    EXPECT_NEAR(environment.texture_coordinates({0, -1, 0}).y, 1.0f, 1e-6f);
    // Near the poles as well, where the cosine tells nothing. 1e-5: a few roundings.
    for (const float angle : {1e-5f, 1e-4f, 1e-3f, 0.1f}) {
        const float v = angle / glm::pi<float>();
        const glm::vec3 up(std::sin(angle), std::cos(angle), 0);
        EXPECT_NEAR(environment.texture_coordinates(up).y, v, 1e-5f * v);
        EXPECT_NEAR(environment.texture_coordinates(-up).y, 1.0f - v, 3e-7f);
    }
    EXPECT_NEAR(environment.texture_coordinates({0, 0, -1}).x, 0.5f, 1e-6f);
    EXPECT_NEAR(environment.texture_coordinates({1, 0, 0}).x, 0.75f, 1e-6f);
}

}  // namespace
}  // namespace plumb

#include "experiments/packed_plane.h"

#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frames/image_error.h"

namespace plumb {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr float infinity = std::numeric_limits<float>::infinity();

Image noise(int width, int height, int channels, float scale) {
    std::mt19937 engine(1);
    std::lognormal_distribution<float> distribution(0.0f, 2.0f);
    Image image(width, height, channels);
    for (float& value : image.values()) value = scale * distribution(engine);
    return image;
}

TEST(PackedPlane, GivesBackValuesWithinItsPrecisionWhateverTheirSize) {
    for (const float scale : {1e-20f, 1e-3f, 1.0f, 1e20f}) {
        for (const int channels : {1, 2, 3, 4}) {
            const Image image = noise(33, 17, channels, scale), back = unpack_plane(pack_plane(image));
            ASSERT_TRUE(back.same_shape(image));
            for (std::size_t i = 0; i < image.values().size(); ++i) {
                const float value = image.values()[i];
                ASSERT_NEAR(back.values()[i], value, packed_plane_precision * value)
                    << "value " << i << ", scale " << scale;
            }
        }
    }
}

TEST(PackedPlane, ReachesItsPrecisionAndNoMore) {
    // 1 + 1/1024 lies half way between the neighbours 1 and 1 + 1/512 of 10 significant bits.
    Image image(2, 1, 1, 1.0f);
    image.at(1, 0) = 1.0f + 1.0f / 1024;
    const Image back = unpack_plane(pack_plane(image));
    EXPECT_EQ(back.at(0, 0), 1.0f);
    EXPECT_EQ(back.at(1, 0), 1.0f + 1.0f / 512);
}

TEST(PackedPlane, KeepsZerosSignsInfinitiesAndNaN) {
    Image image(3, 2, 1);
    const float values[] = {0.0f, -2.5f, infinity, -infinity, std::numeric_limits<float>::quiet_NaN(), 3.0f};
    std::ranges::copy(values, image.values().begin());
    const Image back = unpack_plane(pack_plane(image));
    for (std::size_t i = 0; i < std::size(values); ++i) {
        if (std::isnan(values[i]))
            EXPECT_TRUE(std::isnan(back.values()[i]));
        else
            EXPECT_EQ(back.values()[i], values[i]);
    }
}

TEST(PackedPlane, TakesOneByteForTenPixelsOfASmoothImage) {
    Image image(256, 144, 3);
    for (int y = 0; y < 144; ++y) {
        for (int x = 0; x < 256; ++x) std::ranges::fill(image.pixel(x, y), 0.5f + 0.001f * static_cast<float>(x));
    }
    // Steps of a ramp and repeated channels cost next to nothing; halves alone would be 6 bytes a pixel.
    EXPECT_LT(pack_plane(image).size(), image.pixel_count() / 10);
}

TEST(PackedPlane, RefusesWhatIsNotOne) {
    const std::string whole = pack_plane(noise(8, 8, 3, 1.0f));
    const auto unpack = [](const std::string& bytes) { return [bytes] { unpack_plane(bytes); }; };
    EXPECT_THAT(unpack(whole.substr(0, whole.size() - 9)),
                ThrowsMessage<ImageError>(HasSubstr("8x8 pixels is damaged")));
    EXPECT_THAT(unpack("a png"), ThrowsMessage<ImageError>(HasSubstr("does not begin with a line")));
    EXPECT_THAT(unpack("plumbline-plane 0 8 3 1\n"),
                ThrowsMessage<ImageError>(HasSubstr("begins with 'plumbline-plane 0 8 3 1'")));
    EXPECT_THAT([] { pack_plane(Image()); }, ThrowsMessage<ImageError>(HasSubstr("without pixels")));
}

}  // namespace
}  // namespace plumb

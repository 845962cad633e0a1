#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gmock/gmock.h>

#include "frames/colour_map.h"
#include "frames/exr.h"
#include "frames/image_error.h"
#include "frames/image_file.h"
#include "frames/picture.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string picture_message(const std::filesystem::path& path) {
    try {
        read_frame(path);
    } catch (const ImageError& error) {
        return error.what();
    }
    return "no ImageError";
}

// Writes integer samples as they are.
template <typename Sample>
void write_samples(const std::filesystem::path& path, int width, int height, int channels, const OIIO::TypeDesc& type,
                   const std::vector<Sample>& samples, const char* space = nullptr) {
    OIIO::ImageSpec spec(width, height, channels, type);
    spec["oiio:UnassociatedAlpha"] = 1;
    if (space) spec["oiio:ColorSpace"] = space;
    const auto output = OIIO::ImageOutput::create(path.string());
    ASSERT_TRUE(output && output->open(path.string(), spec)) << OIIO::geterror();
    ASSERT_TRUE(output->write_image(type, samples.data())) << output->geterror();
    ASSERT_TRUE(output->close());
}

TEST(Srgb, CurveHasTheStandardsValues) {
    // IEC 61966-2-1: 0.5 encoded is 0.214041 linear; the straight part has slope 12.92.
    EXPECT_NEAR(srgb_to_linear(0.5f), 0.214041f, 1e-6f) << "float32 pow";
    EXPECT_FLOAT_EQ(srgb_to_linear(0.02f), 0.02f / 12.92f);
    EXPECT_FLOAT_EQ(srgb_to_linear(1.0f), 1.0f);
    for (float value : {0.0f, 0.001f, 0.0031308f, 0.01f, 0.18f, 1.0f, 4.0f, -0.3f}) {
        EXPECT_NEAR(srgb_to_linear(linear_to_srgb(value)), value, 2e-6f * std::max(1.0f, std::abs(value)));
    }
}

TEST(ReadFrame, EightBitPngIsLinearisedAndAlphaKeptApart) {
    const TemporaryFolder folder;
    write_samples<std::uint8_t>(folder / "a.png", 2, 1, 4, OIIO::TypeDesc::UINT8, {0, 128, 255, 51, 255, 10, 188, 255});
    const Frame frame = read_frame(folder / "a.png");
    EXPECT_THAT(frame.plane_names(), ElementsAre("alpha", "total"));
    const Image& total = frame.plane("total");
    EXPECT_EQ(total.channels(), 3);
    EXPECT_FLOAT_EQ(total.at(0, 0, 0), 0.0f);
    EXPECT_NEAR(total.at(0, 0, 1), 0.2158605f, 1e-6f) << "((128/255 + 0.055)/1.055)^2.4, float32";
    EXPECT_FLOAT_EQ(total.at(0, 0, 2), 1.0f) << "not multiplied by alpha";
    EXPECT_FLOAT_EQ(frame.plane("alpha").at(0, 0), 0.2f);
}

TEST(ReadFrame, SixteenBitPngKeepsItsPrecision) {
    const TemporaryFolder folder;
    write_samples<std::uint16_t>(folder / "a.png", 2, 1, 1, OIIO::TypeDesc::UINT16, {32768, 32769});
    const Image& total = read_frame(folder / "a.png").plane("total");
    EXPECT_EQ(total.channels(), 1);
    EXPECT_NEAR(total.at(0, 0), std::pow((32768 / 65535.0 + 0.055) / 1.055, 2.4), 1e-6) << "float32 pow";
    EXPECT_GT(total.at(1, 0), total.at(0, 0));
}

TEST(ReadFrame, FilesThatDeclareLinearValuesAndFloatFilesAreNotDecoded) {
    const TemporaryFolder folder;
    write_samples<std::uint8_t>(folder / "a.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {51, 102, 255}, "Linear");
    write_samples<float>(folder / "a.tif", 1, 1, 3, OIIO::TypeDesc::FLOAT, {0.5f, 2.0f, 100.0f});
    EXPECT_FLOAT_EQ(read_frame(folder / "a.png").plane("total").at(0, 0, 0), 0.2f);
    EXPECT_FLOAT_EQ(read_frame(folder / "a.tif").plane("total").at(0, 0, 0), 0.5f);
    EXPECT_EQ(read_frame(folder / "a.tif").plane("total").at(0, 0, 2), 100.0f);
}

TEST(ReadFrame, GoesByContentNotByName) {
    const TemporaryFolder folder;
    Frame frame(1, 1);
    frame.set("ao", Image(1, 1, 1, 0.75f));
    write_exr(folder / "frame.exr", frame);
    std::filesystem::rename(folder / "frame.exr", folder / "frame.png");
    EXPECT_EQ(read_frame(folder / "frame.png").plane("ao").at(0, 0), 0.75f);
}

TEST(ReadFrame, NamesFileAndRemedyForWhatIsNoImage) {
    const TemporaryFolder folder;
    std::ofstream(folder / "empty.png").close();
    std::ofstream(folder / "text.png") << "no picture";
    write_png(folder / "whole.png", Image(64, 64, 3, 0.3f));
    std::ifstream file(folder / "whole.png", std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(file), {}};
    std::ofstream(folder / "part.png", std::ios::binary) << whole.substr(0, whole.size() / 2);
    EXPECT_THAT(picture_message(folder / "none.png"), AllOf(HasSubstr("none.png"), HasSubstr("no such file")));
    EXPECT_THAT(picture_message(folder / "empty.png"), AllOf(HasSubstr("empty.png"), HasSubstr("0 bytes")));
    EXPECT_THAT(picture_message(folder / "text.png"), AllOf(HasSubstr("text.png"), HasSubstr("give an image file")));
    {
#ifdef __SANITIZE_ADDRESS__
        // libpng leaves OpenImageIO's reader by longjmp, past the destructor of a string of its own.
        const __lsan::ScopedDisabler leak_of_the_library;
#endif
        EXPECT_THAT(picture_message(folder / "part.png"), HasSubstr("part.png"));
    }
    EXPECT_THAT(picture_message(folder.path), HasSubstr("not a file"));
}

TEST(Picture, RadianceTakesExposureThenTheSrgbCurveAndClampsOnlyHere) {
    Image radiance(4, 1, 3, 0.25f);
    radiance.at(1, 0, 0) = 7.0f;
    radiance.at(2, 0, 1) = std::numeric_limits<float>::quiet_NaN();
    radiance.at(3, 0, 2) = -1.0f;
    const Image picture = picture_of_radiance(radiance, 1.0f);
    EXPECT_FLOAT_EQ(picture.at(0, 0, 0), linear_to_srgb(0.5f));
    EXPECT_EQ(picture.at(1, 0, 0), 1.0f);
    EXPECT_EQ(picture.at(2, 0, 0), 1.0f) << "magenta";
    EXPECT_EQ(picture.at(2, 0, 1), 0.0f) << "magenta";
    EXPECT_EQ(picture.at(3, 0, 2), 0.0f);
}

TEST(Picture, PngOfAPictureComesBackWithinHalfAStepOfEightBits) {
    const TemporaryFolder folder;
    Image radiance(16, 16, 3);
    for (std::size_t i = 0; i < radiance.values().size(); ++i) radiance.values()[i] = static_cast<float>(i) / 767.0f;
    write_png(folder / "a.png", "direct", radiance);
    const Image& back = read_frame(folder / "a.png").plane("total");
    for (std::size_t i = 0; i < radiance.values().size(); ++i) {
        // Half a step of the encoded value, and float32 rounding of the curve.
        EXPECT_NEAR(linear_to_srgb(back.values()[i]), linear_to_srgb(radiance.values()[i]), 0.5f / 255.0f + 1e-6f);
    }
}

TEST(Picture, EachPlaneIsShownAsItsNameSays) {
    Image normal(1, 1, 3);
    normal.at(0, 0, 0) = -1.0f;
    normal.at(0, 0, 2) = 1.0f;
    EXPECT_THAT(picture_of_plane("layer2.normal", normal).values(), ElementsAre(0.0f, 0.5f, 1.0f));
    EXPECT_THAT(picture_of_plane("ao", Image(1, 1, 1, 0.4f)).values(), ElementsAre(0.4f, 0.4f, 0.4f));
    Image motion(2, 1, 2);
    motion.at(1, 0, 0) = -8.0f;
    EXPECT_THAT(picture_of_plane("motion", motion).values(), ElementsAre(0.5f, 0.5f, 0.5f, 0.0f, 0.5f, 0.5f));
    Image depth(3, 1, 1);
    depth.at(0, 0) = 2.0f;
    depth.at(1, 0) = 10.0f;
    depth.at(2, 0) = std::numeric_limits<float>::infinity();
    const Image shown = picture_of_plane("depth", depth);
    EXPECT_FLOAT_EQ(shown.at(0, 0), 1.0f);
    EXPECT_FLOAT_EQ(shown.at(1, 0), 0.15f);
    EXPECT_FLOAT_EQ(shown.at(2, 0), 0.0f) << "no surface is black";
}

TEST(ColourMap, MapsAreThoseThatOpenImageIOKnows) {
    // OpenImageIO carries the tables of the same maps (17 knots, linear between), and returns their colours as linear
    // values.
    std::vector<float> ramp(17);
    for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<float>(i) / 16.0f;
    const OIIO::ImageBuf scalars(OIIO::ImageSpec(17, 1, 1, OIIO::TypeDesc::FLOAT), ramp.data());
    for (const auto map : {ColourMap::viridis, ColourMap::magma, ColourMap::inferno}) {
        const OIIO::ImageBuf expected = OIIO::ImageBufAlgo::color_map(scalars, 0, std::string(to_string(map)));
        ASSERT_FALSE(expected.has_error()) << expected.geterror();
        for (int x = 0; x < 17; ++x) {
            for (int c = 0; c < 3; ++c) {
                // 0.02: its knots are entries 0, 16, 32... of 255, taken for sixteenths: up to one entry beside.
                EXPECT_NEAR(colour_at(map, ramp[x])[c], linear_to_srgb(expected.getchannel(x, 0, 0, c)), 0.02f)
                    << to_string(map) << " at " << ramp[x] << ", channel " << c;
            }
        }
    }
}

TEST(ColourMap, DivergingIsWhiteInTheMiddleAndNanIsMagenta) {
    Image scalar(4, 1, 1);
    scalar.at(0, 0) = -2.0f;
    scalar.at(2, 0) = std::numeric_limits<float>::infinity();
    scalar.at(3, 0) = std::numeric_limits<float>::quiet_NaN();
    const Image shown = apply_colour_map(scalar, ColourMap::diverging, -1.0f, 1.0f);
    EXPECT_NEAR(shown.at(0, 0, 2), 0x61 / 255.0f, 1e-6f) << "below low: the first colour";
    EXPECT_NEAR(shown.at(1, 0, 0), 0xf7 / 255.0f, 0.003f) << "a table of 1024 steps has none at exactly 0.5";
    EXPECT_NEAR(shown.at(2, 0, 0), 0x67 / 255.0f, 1e-6f) << "above high: the last colour";
    EXPECT_THAT(std::vector<float>(shown.pixel(3, 0).begin(), shown.pixel(3, 0).end()), ElementsAre(1.0f, 0.0f, 1.0f));
}

TEST(ColourMap, NamesComeBackAndWrongUseIsExplained) {
    EXPECT_EQ(colour_map_from_string("inferno"), ColourMap::inferno);
    EXPECT_THROW(colour_map_from_string("jet"), ImageError);
    EXPECT_THROW(apply_colour_map(Image(1, 1, 3), ColourMap::magma, 0, 1), ImageError);
    EXPECT_THROW(apply_colour_map(Image(1, 1, 1), ColourMap::magma, 1, 1), ImageError);
}

}  // namespace
}  // namespace plumb

#include <bit>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include "frames/channel_names.h"
#include "frames/exr.h"
#include "frames/image_error.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

// Every value is another one, so that swapped channels, rows or planes show.
Image numbered(int width, int height, int channels, float start) {
    Image image(width, height, channels);
    std::iota(image.values().begin(), image.values().end(), start);
    return image;
}

void expect_same_bits(const Image& actual, const Image& expected, const std::string& plane) {
    ASSERT_TRUE(actual.same_shape(expected))
        << plane << ": " << actual.width() << "x" << actual.height() << "x" << actual.channels();
    for (std::size_t i = 0; i < expected.values().size(); ++i) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(actual.values()[i]), std::bit_cast<std::uint32_t>(expected.values()[i]))
            << plane << ", value " << i << ": " << actual.values()[i] << " instead of " << expected.values()[i];
    }
}

std::string read_message(const std::filesystem::path& path) {
    try {
        read_exr(path);
    } catch (const ImageError& error) {
        return error.what();
    }
    return "no ImageError";
}

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Exr, RoundTripKeepsEveryPlaneNameBitAndFact) {
    const TemporaryFolder folder;
    Frame frame(5, 3);
    const std::vector<std::pair<std::string, int>> planes{{"ao", 1},
                                                          {"direct", 3},
                                                          {"indirect", 3},
                                                          {"indirect.1", 3},
                                                          {"indirect.12", 3},
                                                          {"irradiance", 3},
                                                          {"emission", 3},
                                                          {"total", 3},
                                                          {"depth", 1},
                                                          {"normal", 3},
                                                          {"albedo", 3},
                                                          {"motion", 2},
                                                          {"position", 3},
                                                          {"layer2.depth", 1},
                                                          {"layer2.normal", 3},
                                                          {"layer2.motion", 2},
                                                          {"half_a.direct", 3},
                                                          {"half_b.total", 3},
                                                          {"variance.direct", 3},
                                                          {"variance.ao", 1},
                                                          {"half_a.indirect.1", 3},
                                                          {"alpha", 1},
                                                          {"tint", 4},
                                                          {"bins", 12},
                                                          {"layer2.Odd name, Z", 1}};
    float start = 0.25f;
    for (const auto& [name, channels] : planes) frame.set(name, numbered(5, 3, channels, start += 1000.0f));
    frame.facts = {{"scene", "cornell"}, {"view", "front = \"main\"\nsecond line"}, {"samples", "256"}, {"empty", ""}};

    write_exr(folder / "frame.exr", frame);
    const Frame read = read_exr(folder / "frame.exr");

    EXPECT_EQ(read.plane_names(), frame.plane_names());
    EXPECT_EQ(read.facts, frame.facts);
    for (const auto& [name, channels] : planes) expect_same_bits(read.plane(name), frame.plane(name), name);
}

TEST(Exr, RoundTripKeepsInfinityNanPayloadDenormalAndNegativeZero) {
    const TemporaryFolder folder;
    Frame frame(7, 1);
    Image& values = frame.set("direct", Image(7, 1, 1));
    values.at(0, 0) = std::numeric_limits<float>::infinity();
    values.at(1, 0) = -std::numeric_limits<float>::infinity();
    values.at(2, 0) = std::bit_cast<float>(0x7fc12345u);  // a quiet NaN that carries a message
    values.at(3, 0) = std::numeric_limits<float>::denorm_min();
    values.at(4, 0) = -0.0f;
    values.at(5, 0) = std::numeric_limits<float>::max();
    values.at(6, 0) = -1.0f;
    write_exr(folder / "frame.exr", frame);
    expect_same_bits(read_exr(folder / "frame.exr").plane("direct"), values, "direct");
}

TEST(Exr, GreyTotalIsTheRootLuminance) {
    const TemporaryFolder folder;
    Frame frame(2, 2);
    frame.set("total", numbered(2, 2, 1, 1.0f));
    write_exr(folder / "frame.exr", frame);
    expect_same_bits(read_exr(folder / "frame.exr").plane("total"), frame.plane("total"), "total");
}

TEST(Exr, OtherReadersSeeRootColourAndLayersTopRowFirst) {
    const TemporaryFolder folder;
    Frame frame(2, 2);
    frame.set("total", numbered(2, 2, 3, 0.0f));
    frame.set("direct", numbered(2, 2, 3, 100.0f));
    frame.set("depth", numbered(2, 2, 1, 200.0f));
    frame.set("half_a.ao", numbered(2, 2, 1, 300.0f));
    frame.facts["scene"] = "cornell";
    write_exr(folder / "frame.exr", frame);

    const auto input = OIIO::ImageInput::open((folder / "frame.exr").string());
    ASSERT_TRUE(input) << OIIO::geterror();
    const OIIO::ImageSpec& spec = input->spec();
    EXPECT_THAT(spec.channelnames, testing::UnorderedElementsAre("R", "G", "B", "direct.R", "direct.G", "direct.B",
                                                                 "depth.Z", "half_a.ao.Y"));
    EXPECT_EQ(spec.format, OIIO::TypeDesc::FLOAT);
    EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
    EXPECT_EQ(spec.get_string_attribute("plumbline:scene"), "cornell");
    EXPECT_EQ(spec.tile_width, 0) << "scan lines";
    std::vector<float> pixels(4 * spec.channelnames.size());
    ASSERT_TRUE(input->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, pixels.data()));
    const auto value = [&](int x, int y, const char* channel) {
        return pixels[(y * 2 + x) * spec.channelnames.size() + spec.channelindex(channel)];
    };
    EXPECT_EQ(value(1, 0, "G"), 4.0f);
    EXPECT_EQ(value(0, 1, "direct.B"), 108.0f);
    EXPECT_EQ(value(1, 1, "depth.Z"), 203.0f);
    EXPECT_EQ(value(0, 1, "half_a.ao.Y"), 302.0f);
}

TEST(Exr, OiiotoolPrintsTheChannelNames) {
    if (std::system("oiiotool --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "oiiotool is not installed";
    const TemporaryFolder folder;
    Frame frame(2, 2);
    frame.set("total", Image(2, 2, 3));
    frame.set("layer2.normal", Image(2, 2, 3));
    write_exr(folder / "frame.exr", frame);
    const std::string command =
        "oiiotool --info -v '" + (folder / "frame.exr").string() + "' > '" + (folder / "out.txt").string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_THAT(bytes_of(folder / "out.txt"), HasSubstr("R, G, B, layer2.normal.X, layer2.normal.Y, layer2.normal.Z"));
}

// Writes with OpenImageIO what another program might hand over.
struct Foreign {
    OIIO::ImageSpec spec;
    std::vector<float> pixels;

    Foreign(int width, int height, std::vector<std::string> channels, const OIIO::TypeDesc& type)
        : spec(width, height, static_cast<int>(channels.size()), type),
          pixels(channels.size() * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
        spec.channelnames = std::move(channels);
        std::iota(pixels.begin(), pixels.end(), 0.0f);
    }
    void write(const std::filesystem::path& path) {
        const auto output = OIIO::ImageOutput::create(path.string());
        ASSERT_TRUE(output && output->open(path.string(), spec)) << OIIO::geterror();
        ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data())) << output->geterror();
        ASSERT_TRUE(output->close());
    }
};

TEST(Exr, ReadsHalfFloatRootColourAlphaAndDepth) {
    const TemporaryFolder folder;
    Foreign file(4, 2, {"R", "G", "B", "A", "Z"}, OIIO::TypeDesc::HALF);
    file.write(folder / "half.exr");
    const Frame frame = read_exr(folder / "half.exr");
    EXPECT_THAT(frame.plane_names(), ElementsAre("alpha", "depth", "total"));
    EXPECT_EQ(frame.plane("total").channels(), 3);
    EXPECT_EQ(frame.plane("total").at(1, 0, 2), 7.0f);
    EXPECT_EQ(frame.plane("alpha").at(1, 0), 8.0f);
    EXPECT_EQ(frame.plane("depth").at(3, 1), 39.0f);
    EXPECT_TRUE(frame.facts.empty());
}

TEST(Exr, ReadsTiledFiles) {
    const TemporaryFolder folder;
    Foreign file(50, 40, {"R", "G", "B"}, OIIO::TypeDesc::FLOAT);
    file.spec.tile_width = file.spec.tile_height = 16;
    const auto path = folder / "tiled.exr";
    const auto output = OIIO::ImageOutput::create(path.string());
    ASSERT_TRUE(output->open(path.string(), file.spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, file.pixels.data()));
    ASSERT_TRUE(output->close());
    expect_same_bits(read_exr(path).plane("total"), numbered(50, 40, 3, 0.0f), "total");
}

TEST(Exr, ReadsSeveralPartsWithTheirNamesAsLayers) {
    const TemporaryFolder folder;
    const auto path = folder / "parts.exr";
    Foreign colour(3, 2, {"R", "G", "B"}, OIIO::TypeDesc::FLOAT), depth(3, 2, {"Z"}, OIIO::TypeDesc::FLOAT);
    colour.spec["oiio:subimagename"] = "rgb";
    depth.spec["oiio:subimagename"] = "depth";
    const auto output = OIIO::ImageOutput::create(path.string());
    const OIIO::ImageSpec specs[] = {colour.spec, depth.spec};
    ASSERT_TRUE(output->open(path.string(), 2, specs));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, colour.pixels.data()));
    ASSERT_TRUE(output->open(path.string(), depth.spec, OIIO::ImageOutput::AppendSubimage));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, depth.pixels.data()));
    ASSERT_TRUE(output->close());
    const Frame frame = read_exr(path);
    EXPECT_THAT(frame.plane_names(), ElementsAre("depth", "total"));
    EXPECT_EQ(frame.plane("depth").at(2, 1), 5.0f);
}

TEST(Exr, LeavesAwayWhatIsRenderedBeyondTheDisplayWindow) {
    const TemporaryFolder folder;
    Foreign file(6, 4, {"R", "G", "B"}, OIIO::TypeDesc::FLOAT);
    file.spec.x = file.spec.y = -1;  // one pixel of overscan on each side of a 4x2 picture
    file.spec.full_width = 4;
    file.spec.full_height = 2;
    file.write(folder / "overscan.exr");
    const Frame frame = read_exr(folder / "overscan.exr");
    EXPECT_EQ(frame.width(), 4);
    EXPECT_EQ(frame.height(), 2);
    EXPECT_EQ(frame.plane("total").at(0, 0, 0), (1 * 6 + 1) * 3.0f);
    EXPECT_EQ(frame.plane("total").at(3, 1, 2), (2 * 6 + 4) * 3.0f + 2.0f);
    EXPECT_TRUE(frame.facts.empty());
}

TEST(Exr, ACropRenderIsItsCropAndSaysSo) {
    const TemporaryFolder folder;
    Foreign file(2, 1, {"R", "G", "B"}, OIIO::TypeDesc::FLOAT);
    file.spec.x = 3;
    file.spec.y = 5;
    file.spec.full_width = 16;
    file.spec.full_height = 9;
    file.write(folder / "crop.exr");
    const Frame frame = read_exr(folder / "crop.exr");
    EXPECT_EQ(frame.width(), 2);
    EXPECT_EQ(frame.height(), 1);
    EXPECT_EQ(frame.facts.at("data_window"), "2x1 at 3,5 of 16x9");
}

TEST(Exr, RejectsWhatIsNoImageNamingFileAndRemedy) {
    const TemporaryFolder folder;
    std::ofstream(folder / "empty.exr").close();
    std::ofstream(folder / "text.exr") << "this is a text";
    std::ofstream(folder / "header.exr", std::ios::binary) << std::string("\x76\x2f\x31\x01\x02\x00\x00\x00", 8);
    EXPECT_THAT(read_message(folder / "missing.exr"), AllOf(HasSubstr("missing.exr"), HasSubstr("no such file")));
    EXPECT_THAT(read_message(folder / "empty.exr"), AllOf(HasSubstr("empty.exr"), HasSubstr("0 bytes")));
    EXPECT_THAT(read_message(folder / "text.exr"), AllOf(HasSubstr("text.exr"), HasSubstr("not an OpenEXR file")));
    EXPECT_THAT(read_message(folder / "header.exr"), AllOf(HasSubstr("header.exr"), HasSubstr("truncated")));
    EXPECT_THAT(read_message(folder.path), HasSubstr("not a file"));
}

TEST(Exr, EveryTruncationAndEveryDamagedHeaderByteIsAnErrorOrAnImageNeverACrash) {
    const TemporaryFolder folder;
    Frame frame(20, 40);
    frame.set("total", numbered(20, 40, 3, 0.0f));
    frame.set("depth", numbered(20, 40, 1, 0.5f));
    write_exr(folder / "whole.exr", frame);
    const std::string whole = bytes_of(folder / "whole.exr");
    int truncated_errors = 0, truncations = 0;
    for (std::size_t length = 1; length < whole.size(); length += 37) {
        std::ofstream(folder / "part.exr", std::ios::binary) << whole.substr(0, length);
        const std::string message = read_message(folder / "part.exr");
        truncated_errors += message.find("part.exr") != std::string::npos;
        ++truncations;
    }
    EXPECT_EQ(truncated_errors, truncations) << "a file that lacks its end must never pass for a whole one";
    for (std::size_t byte = 4; byte < 400; ++byte) {
        std::string damaged = whole;
        damaged[byte] = static_cast<char>(damaged[byte] ^ 0x7f);
        std::ofstream(folder / "damaged.exr", std::ios::binary) << damaged;
        read_message(folder / "damaged.exr");
    }
}

TEST(Exr, RefusesFramesThatAFileCannotHold) {
    const TemporaryFolder folder;
    const auto message = [&](const Frame& frame) -> std::string {
        try {
            write_exr(folder / "frame.exr", frame);
        } catch (const ImageError& error) {
            return error.what();
        }
        return "no ImageError";
    };
    EXPECT_THAT(message(Frame{}), HasSubstr("0x0 with 0 planes"));
    Frame rgba(1, 1);
    rgba.set("total", Image(1, 1, 4));
    EXPECT_THAT(message(rgba), AllOf(HasSubstr("'total' has 4 channels"), HasSubstr("'alpha'")));
    Frame unnamed(1, 1);
    unnamed.set("", Image(1, 1, 1));
    EXPECT_THAT(message(unnamed), HasSubstr("without a name"));
}

TEST(ChannelNames, ForeignNamesFindTheirPlanes) {
    const auto planes = [](std::vector<std::string> names) {
        std::string text;
        for (const auto& group : group_channels(names)) {
            text += (text.empty() ? "" : "; ") + group.plane + " =";
            for (const auto& channel : group.channels) text += " " + channel;
        }
        return text;
    };
    EXPECT_EQ(planes({"B", "G", "R"}), "total = R G B");
    EXPECT_EQ(planes({"Y"}), "total = Y");
    EXPECT_EQ(planes({"N.x", "N.y", "N.z"}), "N = N.x N.y N.z");
    EXPECT_EQ(planes({"albedo.b", "albedo.g", "albedo.r"}), "albedo = albedo.r albedo.g albedo.b");
    EXPECT_EQ(planes({"Z", "depth.Z"}), "Z = Z; depth = depth.Z");
    EXPECT_EQ(planes({"R", "G", "B", "total.R", "total.G", "total.B"}),
              "root = R G B; total = total.R total.G total.B");
    EXPECT_EQ(planes({"id"}), "id = id");
    EXPECT_EQ(planes({"a.left", "a.right"}), "a.left = a.left; a.right = a.right");
    EXPECT_EQ(planes({"uv.U", "uv.V", "uv.A"}), "uv = uv.U uv.V uv.A");
}

}  // namespace
}  // namespace plumb

#include <cstdlib>
#include <limits>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include "frames/deep_exr.h"
#include "frames/exr.h"
#include "frames/image_error.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr float infinity = std::numeric_limits<float>::infinity();

// 2 x 2 pixels: two surfaces, one, none, two.
Frame two_layers() {
    Frame frame(2, 2);
    const auto depth = [&](const char* name, std::array<float, 4> values) {
        Image image(2, 2, 1);
        std::ranges::copy(values, image.values().begin());
        frame.set(name, image);
    };
    depth("depth", {1.0f, 2.0f, infinity, 4.0f});
    depth("layer2.depth", {5.0f, infinity, infinity, 8.0f});
    for (int layer = 0; layer < 2; ++layer) {
        Image direct(2, 2, 3), normal(2, 2, 3);
        for (std::size_t i = 0; i < direct.values().size(); ++i) {
            direct.values()[i] = 100.0f * static_cast<float>(layer) + static_cast<float>(i);
            normal.values()[i] = -direct.values()[i];
        }
        frame.set(layer == 0 ? "direct" : "layer2.direct", direct);
        frame.set(layer == 0 ? "normal" : "layer2.normal", normal);
    }
    frame.set("ao", Image(2, 2, 1, 0.5f));
    frame.set("layer2.albedo", Image(2, 2, 3, 0.5f));
    frame.facts["scene"] = "made up";
    return frame;
}

TEST(DeepExr, HoldsASampleForEachLayerThatHasASurface) {
    const TemporaryFolder folder;
    const auto path = folder / "deep.exr";
    EXPECT_THAT(write_deep_exr(path, two_layers()), ElementsAre("ao", "layer2.albedo"));

    Imf::DeepScanLineInputFile file(path.c_str());
    EXPECT_EQ(file.header().type(), Imf::DEEPSCANLINE);
    EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>("plumbline:scene").value(), "made up");
    std::vector<std::string> names;
    for (auto c = file.header().channels().begin(); c != file.header().channels().end(); ++c) names.push_back(c.name());
    EXPECT_THAT(names, ElementsAre("A", "B", "G", "R", "Z", "direct.B", "direct.G", "direct.R", "normal.X", "normal.Y",
                                   "normal.Z"));

    std::array<unsigned, 4> counts{};
    std::map<std::string, std::array<std::array<float, 2>, 4>> samples;
    std::map<std::string, std::array<float*, 4>> pointers;
    Imf::DeepFrameBuffer buffer;
    buffer.insertSampleCountSlice(
        Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned), 2 * sizeof(unsigned)));
    for (const std::string name : {"Z", "A", "R", "B", "normal.Y"}) {
        for (std::size_t i = 0; i < 4; ++i) pointers[name][i] = samples[name][i].data();
        buffer.insert(name, Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers[name].data()), sizeof(float*),
                                           2 * sizeof(float*), sizeof(float)));
    }
    file.setFrameBuffer(buffer);
    file.readPixelSampleCounts(0, 1);
    EXPECT_THAT(counts, ElementsAre(2u, 1u, 0u, 2u));
    file.readPixels(0, 1);
    EXPECT_THAT(samples["Z"][0], ElementsAre(1.0f, 5.0f));
    EXPECT_EQ(samples["Z"][1][0], 2.0f);
    EXPECT_THAT(samples["Z"][3], ElementsAre(4.0f, 8.0f));
    EXPECT_THAT(samples["A"][3], ElementsAre(1.0f, 1.0f));
    EXPECT_THAT(samples["R"][3], ElementsAre(9.0f, 109.0f));  // the first of pixel 3's three values
    EXPECT_THAT(samples["B"][0], ElementsAre(2.0f, 102.0f));
    EXPECT_THAT(samples["normal.Y"][3], ElementsAre(-10.0f, -110.0f));
}

TEST(DeepExr, OpenImageIoReadsIt) {
    const TemporaryFolder folder;
    const auto path = folder / "deep.exr";
    write_deep_exr(path, two_layers());
    const auto input = OIIO::ImageInput::open(path.string());
    ASSERT_TRUE(input) << OIIO::geterror();
    EXPECT_TRUE(input->spec().deep);
    OIIO::DeepData deep;
    ASSERT_TRUE(input->read_native_deep_image(0, 0, deep)) << input->geterror();
    ASSERT_EQ(deep.pixels(), 4);
    EXPECT_EQ(deep.samples(0), 2);
    EXPECT_EQ(deep.samples(2), 0);
    const int z = deep.Z_channel();
    ASSERT_GE(z, 0);
    EXPECT_EQ(deep.deep_value(3, z, 1), 8.0f);
    if (std::system("oiiotool --version > /dev/null 2>&1") == 0) {
        const std::string flat = (folder / "flat.exr").string();
        ASSERT_EQ(std::system(("oiiotool '" + path.string() + "' --flatten -o '" + flat + "'").c_str()), 0);
        // What is in front: the first layer.
        EXPECT_EQ(read_exr(flat).plane("total").at(1, 1, 0), 9.0f);
    }
}

TEST(DeepExr, ADepthIsNeeded) {
    const TemporaryFolder folder;
    Frame frame(2, 2);
    frame.set("direct", Image(2, 2, 3));
    try {
        write_deep_exr(folder / "deep.exr", frame);
        FAIL() << "wrote samples without a depth";
    } catch (const ImageError& error) {
        EXPECT_THAT(error.what(), HasSubstr("no plane 'depth'"));
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "deep.exr"));
}

}  // namespace
}  // namespace plumb

// `plumbline render` from the outside: the files that it leaves.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frames/exr.h"
#include "tests/experiments/program.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::HasSubstr;

// The channel of a deep image by its name.
int channel_of(const OIIO::ImageSpec& spec, const std::string& name) {
    const int channel = spec.channelindex(name);
    EXPECT_GE(channel, 0) << name << " is missing";
    return channel;
}

TEST(RenderCommand, DeepWritesBothLayersOfTheFlatFile) {
    const TemporaryFolder folder;
    const ProgramRun run =
        run_plumbline({"render", "clutter", "--method", "two_layers", "--size", "48", "32", "--deep", "--repetitions",
                       "0", "--planes", "depth,layer2.depth,normal,layer2.normal,direct,layer2.direct,ao", "--output",
                       folder.path.string()});
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("without ao: not of every layer"));
    std::filesystem::path deep_file, flat_file;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path)) {
        const std::string name = entry.path().filename().string();
        if (name.ends_with(".deep.exr")) {
            deep_file = entry.path();
        } else if (name.ends_with(".exr")) {
            flat_file = entry.path();
        }
    }
    const Frame flat = read_exr(flat_file);
    const auto input = OIIO::ImageInput::open(deep_file.string());
    ASSERT_TRUE(input) << OIIO::geterror();
    ASSERT_TRUE(input->spec().deep);
    ASSERT_EQ(input->spec().width, flat.width());
    ASSERT_EQ(input->spec().height, flat.height());
    OIIO::DeepData deep;
    ASSERT_TRUE(input->read_native_deep_image(0, 0, deep)) << input->geterror();
    const int depth_channel = channel_of(input->spec(), "Z"), normal_channel = channel_of(input->spec(), "normal.X"),
              direct_channel = channel_of(input->spec(), "direct.G");
    int both = 0;
    for (int y = 0; y < flat.height(); ++y) {
        for (int x = 0; x < flat.width(); ++x) {
            const int pixel = y * flat.width() + x;
            int sample = 0;
            for (const std::string prefix : {"", "layer2."}) {
                const float depth = flat.plane(prefix + "depth").at(x, y);
                if (std::isinf(depth)) continue;
                ASSERT_LT(sample, deep.samples(pixel)) << x << ", " << y;
                // The very floats: both files are lossless.
                EXPECT_EQ(deep.deep_value(pixel, depth_channel, sample), depth);
                EXPECT_EQ(deep.deep_value(pixel, normal_channel, sample), flat.plane(prefix + "normal").at(x, y, 0));
                EXPECT_EQ(deep.deep_value(pixel, direct_channel, sample), flat.plane(prefix + "direct").at(x, y, 1));
                ++sample;
            }
            EXPECT_EQ(deep.samples(pixel), sample) << x << ", " << y;
            both += sample == 2;
        }
    }
    EXPECT_GT(both, 300) << "pixels in which both layers hold a surface";
}

TEST(RenderCommand, DeepWithoutDepthIsRefusedWithTheRemedy) {
    const TemporaryFolder folder;
    const ProgramRun run = run_plumbline({"render", "cornell", "--size", "16", "12", "--deep", "--repetitions", "0",
                                          "--planes", "direct", "--output", folder.path.string()});
    EXPECT_NE(run.exit_code, 0);
    EXPECT_THAT(run.output, HasSubstr("depth"));
}

// What is set for this very scene is refused; what a method brings along is noted.
TEST(RenderCommand, WhatTheSceneHasNothingForIsTold) {
    const TemporaryFolder folder;
    const auto render = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {
            "render", "cornell",  "--planes",           "direct",        "--size", "16",
            "16",     "--output", folder.path.string(), "--repetitions", "0"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_plumbline(arguments);
    };
    const ProgramRun refused = render({"--set", "direct.shadow.map_size=512"});
    EXPECT_NE(refused.exit_code, 0);
    EXPECT_THAT(refused.output, testing::AllOf(HasSubstr("'direct.shadow.map_size=512'"),
                                               HasSubstr("nothing in scene 'cornell' is concerned")));
    folder.write("mine.toml", "name = \"mine\"\ndirect.shadow.map_size = 512\nao.bias = 0.02\n");
    const ProgramRun noted = render({"--method", (folder.path / "mine.toml").string()});
    EXPECT_EQ(noted.exit_code, 0) << noted.output;
    EXPECT_THAT(noted.output, testing::AllOf(HasSubstr("note: direct.shadow.map_size = 512 has no effect"),
                                             testing::Not(HasSubstr("ao.bias"))));
}

}  // namespace
}  // namespace plumb

// The command's exit codes and messages, from the outside.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frames/exr.h"
#include "tests/experiments/program.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

void expect(const std::vector<std::string>& arguments, int exit_code,
            const testing::Matcher<const std::string&>& output) {
    const ProgramRun run = run_plumbline(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.output;
    EXPECT_THAT(run.output, output);
}

std::string write_image(const TemporaryFolder& folder, const std::string& name, float value) {
    Frame frame(32, 32);
    frame.set("total", Image(32, 32, 3, value));
    const auto file = folder.path / name;
    write_exr(file, frame);
    return file.string();
}

TEST(CommandLine, HelpIsFineAndShowsExamples) {
    expect({"--help"}, 0, AllOf(HasSubstr("Examples:"), HasSubstr("Exit codes")));
    for (const char* command : {"doctor", "scenes", "render", "reference", "compare", "run"}) {
        expect({command, "--help"}, 0, HasSubstr(std::string("plumbline ") + command));
    }
    expect({"--version"}, 0, HasSubstr("plumbline 0."));
}

TEST(CommandLine, WrongUseExitsWithTwoAndSaysWhatIsWrong) {
    expect({}, 2, HasSubstr("subcommand"));
    expect({"rendr"}, 2, HasSubstr("did you mean 'render'?"));
    expect({"render"}, 2, HasSubstr("scene is required"));
    expect({"render", "cornell", "--backend", "vulkan"}, 2, HasSubstr("--backend"));
    expect({"reference", "cornell", "--samples", "3"}, 2, HasSubstr("must be even"));
    expect({"render", "cornell", "--size", "0", "10"}, 2, HasSubstr("--size"));
}

TEST(CommandLine, BadInputExitsWithTwoAndSaysWhatWouldDo) {
    expect({"render", "cornel"}, 2, HasSubstr("did you mean 'cornell'?"));
    expect({"reference", "cornell", "--view", "frnt", "--samples", "2"}, 2, HasSubstr("front"));
    expect({"render", "cornell", "--method", "two_layer"}, 2, HasSubstr("did you mean 'two_layers'?"));
    expect({"render", "cornell", "--set", "ao.sampels=3"}, 2, HasSubstr("did you mean 'ao.samples'?"));
    expect({"run", "no_such_file.toml"}, 2, HasSubstr("no_such_file.toml"));
    expect({"compare", "a.exr", "b.exr"}, 2, HasSubstr("'a.exr'"));
    expect({"scenes", "no_such_scene"}, 2, HasSubstr("no_such_scene"));
    expect({"--scenes-dir", "/no/such/folder", "scenes"}, 2, HasSubstr("/no/such/folder"));
}

TEST(CommandLine, AnExperimentWithAMistakeExitsWithTwoAndNamesTheLine) {
    const TemporaryFolder folder;
    const auto file = folder.path / "broken.toml";
    std::ofstream(file)
        << "planes = [\"ao\"]\nsampels = 3\nmethods = [\"one_layer\"]\n[[scenes]]\nscene = \"cornell\"\n";
    expect({"run", file.string()}, 2, HasSubstr("broken.toml:2: sampels"));
}

TEST(CommandLine, AMethodPrintsAllItsParameters) {
    expect({"render", "cornell", "--method", "one_layer", "--set", "ao.samples=7", "--print-method"}, 0,
           AllOf(HasSubstr("gbuffer.layers = 1\n"), HasSubstr("ao.samples = 7\n"),
                 HasSubstr("radiosity.blur.monotonic = true\n")));
}

TEST(CommandLine, AFrameOnAPathIsRenderedAfterThoseBeforeIt) {
    const TemporaryFolder folder;
    const std::vector<std::string> walk = {"render", "clutter-moving", "--path", "strafe",   "--time",
                                           "1",      "--size",         "32",     "24",       "--repetitions",
                                           "0",      "--planes",       "ao",     "--output", folder.path.string()};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), walk.begin(), walk.end());
        return more;
    };
    expect(with({"--frames", "3"}), 0, HasSubstr("frame 3 of 3, at 1.000 s"));
    // As many as the history needs: 0.5^7 is less than a hundredth.
    expect(with({"--set", "ao.temporal.alpha=0.5"}), 0, HasSubstr("frame 8 of 8, at 1.000 s"));
    expect(with({"--frames", "0"}), 2, HasSubstr("--frames"));
}

TEST(CommandLine, DoctorTellsWhatThereIs) {
    const ProgramRun run = run_plumbline({"doctor"});
    EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 3) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr("Embree"), HasSubstr("OpenGL contexts"), HasSubstr("Memory")));
}

TEST(CommandLine, ScenesListsTheBuiltInOnesAndShowsOne) {
    expect({"scenes"}, 0, AllOf(HasSubstr("cornell"), HasSubstr("colonnade"), HasSubstr("clutter")));
    expect({"scenes", "cornell"}, 0, AllOf(HasSubstr("triangles   32"), HasSubstr("front"), HasSubstr("strafe")));
}

TEST(CommandLine, TheGatePassesEqualImagesAndFailsDifferentOnes) {
    const TemporaryFolder folder;
    const std::string dark = write_image(folder, "dark.exr", 0.5f), same = write_image(folder, "same.exr", 0.5f);
    const std::string bright = write_image(folder, "bright.exr", 0.6f);
    expect({"compare", dark, same, "--fail-above", "rmse=0.01", "--fail-below", "psnr=60"}, 0, HasSubstr("rmse"));
    // The pair that must fail proves that the gate can: the difference is 0.1 everywhere.
    expect({"compare", bright, dark, "--fail-above", "rmse=0.01,p95=0.2"}, 1,
           HasSubstr("total: rmse = 0.1 is above 0.01"));
    expect({"compare", bright, dark, "--fail-below", "psnr=60"}, 1, HasSubstr("psnr"));
    expect({"compare", bright, dark, "--fail-above", "rmse=0.2"}, 0, HasSubstr("rmse"));
    expect({"compare", bright, dark, "--fail-above", "rsme=0.2"}, 2, HasSubstr("did you mean 'rmse'?"));
    expect({"compare", bright, dark, "--fail-above", "rmse=low"}, 2, HasSubstr("measure=number"));
}

TEST(CommandLine, CompareWritesJsonAndHeatMaps) {
    const TemporaryFolder folder;
    const std::string dark = write_image(folder, "dark.exr", 0.5f), bright = write_image(folder, "bright.exr", 0.6f);
    expect({"compare", bright, dark, "--json", "--heat-map", (folder.path / "maps").string()}, 0,
           HasSubstr("\"rmse\": 0.1"));
    EXPECT_TRUE(std::filesystem::exists(folder.path / "maps" / "total.error.png"));
    expect({"compare", bright, dark, "--heat-map", (folder.path / "maps").string(), "--map", "flip", "--flip",
            "displayed"},
           0, HasSubstr("FLIP from 0 (black) to 1 (yellow)"));
    expect({"compare", bright, dark, "--heat-map", (folder.path / "maps").string(), "--map", "ssim"}, 0,
           HasSubstr("1 - SSIM from 0"));
    expect({"compare", bright, dark, "--exposures", "-4to3"}, 2, HasSubstr("such as -4..3"));
    expect({"compare", bright, dark, "--flip", "radiance", "--exposures", "-4..3", "--pixels-per-degree", "40"}, 0,
           HasSubstr("flip_first_exposure"));
    for (const char* file : {"total.flip.png", "total.ssim.png"})
        EXPECT_TRUE(std::filesystem::exists(folder.path / "maps" / file)) << file;
}

TEST(CommandLine, ImagesOfDifferentSizesCannotBeCompared) {
    const TemporaryFolder folder;
    Frame small(16, 16);
    small.set("total", Image(16, 16, 3, 0.5f));
    write_exr(folder.path / "small.exr", small);
    expect({"compare", write_image(folder, "big.exr", 0.5f), (folder.path / "small.exr").string()}, 2,
           AllOf(HasSubstr("32x32"), HasSubstr("16x16")));
}

TEST(CommandLine, ReferenceWritesPlanesThatCompareWithThemselves) {
    const TemporaryFolder folder;
    const std::string out = folder.path.string();
    expect({"reference", "cornell", "--size", "32", "18", "--samples", "4", "--output", out}, 0,
           HasSubstr("4 samples per pixel"));
    const std::string exr = (folder.path / "cornell.front.reference.exr").string();
    const Frame frame = read_exr(exr);
    EXPECT_TRUE(frame.has("half_a.ao"));
    EXPECT_TRUE(std::filesystem::exists(folder.path / "cornell.front.reference.total.png"));
    expect({"compare", exr, exr, "--fail-above", "maximum=0"}, 0, HasSubstr("indirect"));
}

TEST(Scripts, CanBeStartedAsTheReadmeSays) {
    int scripts = 0;
    for (const auto& entry : std::filesystem::directory_iterator(PLUMBLINE_SOURCE_DIR "/scripts")) {
        ++scripts;
        EXPECT_NE(entry.status().permissions() & std::filesystem::perms::owner_exec, std::filesystem::perms::none)
            << entry.path();
    }
    EXPECT_GT(scripts, 0);
}

}  // namespace
}  // namespace plumb

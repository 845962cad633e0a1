#include "experiments/disk_use.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frames/image_error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// 100 pixels; ao has one channel, indirect three and two truths.
Experiment small_experiment() {
    Experiment experiment;
    experiment.width = 20, experiment.height = 5;
    experiment.planes = {"ao", "indirect"};
    experiment.methods.resize(2);
    experiment.path_tracer_samples = {};
    experiment.scenes.resize(1);
    experiment.scenes[0].scene = "cornell", experiment.scenes[0].views = {"front", "gap"};
    return experiment;
}

constexpr std::uintmax_t full = std::uintmax_t{100} * (1 + 3) * 4,
                         limited = std::uintmax_t{100} * 3 * 4;  // bytes of one image of every plane

DiskUse disk_use_of(const Experiment& experiment, bool write_frames) {
    const SceneFinder finder({});
    LoadedScenes scenes(finder);
    return disk_use(experiment, scenes, write_frames);
}

TEST(DiskUse, CountsTruthsWithTheirHalvesAndVarianceForTheCache) {
    Experiment experiment = small_experiment();
    EXPECT_EQ(disk_use_of(experiment, true).cache, (full + limited) * 2 * 4);
    experiment.oracle_layers = {1, 0}, experiment.oracle_bounces = {1};
    EXPECT_EQ(disk_use_of(experiment, true).cache, (full + limited) * 2 * 4 + full * 3 * 2 * 4);
    experiment.oracle_layers.clear(), experiment.oracle_bounces.clear();
    experiment.scenes[0].paths.resize(1);
    experiment.scenes[0].paths[0].frames = 6;
    EXPECT_EQ(disk_use_of(experiment, true).cache, (full + limited) * 2 * 4 + full * 6 * 4);
}

TEST(DiskUse, CountsCellsFramesPicturesAndTheirValuesForTheOutput) {
    Experiment experiment = small_experiment();
    const std::uintmax_t pictures = full * 2 * 5 / 4, values = full * 2 * 3 / 2;  // two views; truth and methods
    const std::uintmax_t without_frames = full * 2 * 2 + pictures + values;
    EXPECT_EQ(disk_use_of(experiment, false).output, without_frames);
    EXPECT_EQ(disk_use_of(experiment, true).output, without_frames + 2 * (4 * (full + limited) + 2 * full));
    experiment.seeds = 3, experiment.path_tracer_samples = {2};
    EXPECT_EQ(disk_use_of(experiment, false).output, full * 2 * (2 * 3 + 1) + pictures + values);
}

TEST(DiskUse, LooksAtTheSceneForViewsThatAreNotNamedAndLeavesOutWhatIsNotThere) {
    Experiment experiment = small_experiment();
    experiment.scenes[0].views = {};
    const std::uintmax_t views = SceneFinder({}).load("cornell").cameras.size();
    EXPECT_EQ(disk_use_of(experiment, false).cache, views * 4 * (full + limited));
    experiment.scenes[0].scene = "no_such_scene";
    EXPECT_EQ(disk_use_of(experiment, false).cache, 0u);
}

TEST(DiskUse, SaysWhatIsFreeAndRefusesWhatDoesNotFit) {
    const TemporaryFolder folder;
    const auto cache = folder.path / "not/made/yet", output = folder.path / "out";
    EXPECT_EQ(print_disk_use({2'000'000'000, 30'000'000}), "at most 2 GB of references and 0.03 GB of results");
    EXPECT_THAT(
        describe_disk_use({2'000'000, 30'000'000}, cache, output),
        AllOf(HasSubstr("0.002 GB of references in '" + cache.string()), HasSubstr("0.03 GB in '"), HasSubstr("free")));
    constexpr auto too_much = std::numeric_limits<std::uintmax_t>::max();
    EXPECT_THAT(message_of<ImageError>([&] {
                    describe_disk_use({too_much, 0}, cache, output);
                }),
                AllOf(HasSubstr("'" + cache.string()), HasSubstr("--cache-dir")));
    EXPECT_THAT(message_of<ImageError>([&] {
                    describe_disk_use({0, too_much}, cache, output);
                }),
                AllOf(HasSubstr("'" + output.string()), HasSubstr("--output")));
}

}  // namespace
}  // namespace plumb

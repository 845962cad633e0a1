// `plumbline tune` as its users run it, at thumbnail size.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/method_file.h"
#include "experiments/method_parameters.h"
#include "tests/experiments/program.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Ambient obscurance of this strength is far too dark in the box, whatever the noise of so small a truth.
constexpr const char* experiment = R"(name = "thumbnail"
planes = ["ao"]
resolution = [64, 36]
methods = ["two_layers"]
[reference]
samples = 64
most_noise = 10.0
[timing]
repetitions = 1
[[scenes]]
scene = "cornell"
views = ["front", "blocks", "gap"]
ao_radius = 0.1
minimum_separation = 0.03
method.ao.bias = 0.001
)";

class TuneCommand : public testing::Test {
protected:
    void SetUp() override { std::ofstream(folder_.path / "thumbnail.toml") << experiment; }

    ProgramRun tune(const std::string& free_parameter) const {
        return run_plumbline({"tune", "two_layers", "--on", (folder_.path / "thumbnail.toml").string(), "--plane", "ao",
                              "--free", free_parameter, "--steps", "3", "--passes", "1", "--name", "mine", "--output",
                              (folder_.path / "mine.toml").string(), "--cache-dir", (folder_.path / "cache").string()});
    }

    TemporaryFolder folder_;
};

TEST_F(TuneCommand, WritesABetterMethodAndJudgesItOnHeldOutViews) {
    const ProgramRun run = tune("ao.intensity=0.25..1");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr("Disk: at most"), HasSubstr("training"), HasSubstr("held out"),
                                  HasSubstr("ao.intensity: 1")));
    const Method start = load_method("two_layers"), tuned = load_method((folder_.path / "mine.toml").string());
    EXPECT_EQ(tuned.name, "mine");
    EXPECT_LT(tuned.ao.intensity, start.ao.intensity) << run.output;
    for (const MethodDifference& difference : diff_methods(start, tuned)) {
        EXPECT_EQ(difference.parameter, "ao.intensity") << "nothing else was free";
    }
}

TEST_F(TuneCommand, RefusesErrorsThatTheTruthIsTooNoisyFor) {
    std::string noisy = experiment;
    noisy.replace(noisy.find("samples = 64\nmost_noise = 10.0"), 30, "samples = 2\nmost_noise = 0.001");
    std::ofstream(folder_.path / "thumbnail.toml") << noisy;
    const ProgramRun run = tune("ao.intensity=0.25..1");
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr("refused, cornell / front: not measured"), HasSubstr("samples per pixel"),
                                  HasSubstr("nothing can be tuned")));
    EXPECT_FALSE(std::filesystem::exists(folder_.path / "mine.toml"));
}

TEST_F(TuneCommand, RefusesWhatTheSceneOverrides) {
    const ProgramRun run = tune("ao.bias=0.001..0.01");
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr("cornell"), HasSubstr("ao.bias")));
    EXPECT_FALSE(std::filesystem::exists(folder_.path / "mine.toml"));
}

}  // namespace
}  // namespace plumb

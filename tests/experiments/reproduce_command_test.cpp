// `plumbline reproduce` as its users run it, at thumbnail size.
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/experiments/program.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// A trial run divides the resolution by four.
constexpr const char* experiment = R"(title = "A trial"
question = "Which errs less?"
planes = ["ao"]
resolution = [192, 108]
methods = ["one_layer", "two_layers"]
path_tracer_samples = []
[timing]
repetitions = 1
[[scenes]]
scene = "cornell"
views = ["front", "gap"]
ao_radius = 0.1
minimum_separation = 0.03
[[figures]]
title = "Times of each view"
kind = "bars"
y = "ms"
x = "place"
[[figures]]
title = "Times"
kind = "table"
rows = ["method"]
columns = ["ms"]
[[claims]]
claim = "Two layers take longer."
source = "000, section 1"
test = "time, two layers over one"
measure = "ms"
ratio = [{ method = "two_layers" }, { method = "one_layer" }]
above = 1.0
)";

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

class ReproduceCommand : public testing::Test {
protected:
    void SetUp() override {
        write("trial.toml", experiment);
        std::string lost = experiment;
        write("lost.toml", lost.replace(lost.find("\"cornell\""), 9, "\"nowhere/missing.toml\"\noptional = true"));
    }
    void write(const std::string& name, const std::string& text) const { std::ofstream(folder_.path / name) << text; }

    ProgramRun reproduce(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "reproduce");
        arguments.insert(arguments.end(), {"--quick", "--output", (folder_.path / "out").string(), "--cache-dir",
                                           (folder_.path / "cache").string()});
        return run_plumbline(arguments);
    }
    std::string file(const std::string& name) const { return (folder_.path / name).string(); }
    std::string written(const std::string& name) const { return text_of(folder_.path / "out/trial" / name); }

    TemporaryFolder folder_;
};

TEST_F(ReproduceCommand, WritesFiguresAsSvgPngAndCsvAndGoesOnBehindAnExperimentThatFails) {
    const ProgramRun run = reproduce({file("lost.toml"), file("trial.toml"), "--report", file("CLAIMS.md")});
    EXPECT_EQ(run.exit_code, 1) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr("Disk, all together: at most"), HasSubstr("Disk: at most"),
                                  HasSubstr("1 failed:\n  " + file("lost.toml") + ": "),
                                  HasSubstr("all of its scenes are optional, and none is here")));
    EXPECT_GT(run.output.find("1 failed:"), run.output.find("1 claims: ")) << "what failed is listed at the end";
    for (const std::string figure : {"figure-1", "figure-2"}) {
        EXPECT_THAT(written(figure + ".svg"), AllOf(testing::StartsWith("<svg"), testing::EndsWith("</svg>\n")));
        EXPECT_THAT(written(figure + ".png"), testing::StartsWith("\x89PNG"));
        EXPECT_THAT(written(figure + ".csv"), HasSubstr("two_layers,"));
    }
    EXPECT_THAT(written("README.md"),
                AllOf(HasSubstr("![Times of each view](figure-1.png)"), HasSubstr("This was a trial run")));
    EXPECT_THAT(written("README.md"),
                AllOf(HasSubstr("`plumbline reproduce trial.toml --quick`"), Not(HasSubstr(folder_.path.string()))));
    EXPECT_THAT(text_of(folder_.path / "CLAIMS.md"), HasSubstr("Two layers take longer."));
    EXPECT_THAT(written("run/results.json"), HasSubstr("Which errs less?")) << "the run can be repeated from it";
}

TEST_F(ReproduceCommand, ItsReadmeNamesASceneThatIsNotHereWithoutTheFoldersOfThisMachine) {
    write("lamp.toml", "mesh = \"lamp.obj\"\n");
    write("trial.toml", std::string(experiment) + "[[scenes]]\nscene = \"lamp.toml\"\noptional = true\n");
    const ProgramRun run = reproduce({file("trial.toml"), "--scenes-dir", folder_.path.string()});
    EXPECT_EQ(run.exit_code, 0) << run.output;
    const std::string readme = written("README.md");
    const std::size_t start = readme.find("\nLeft out: lamp.toml: ");
    ASSERT_NE(start, std::string::npos) << readme;
    EXPECT_THAT(
        readme.substr(start, readme.find('\n', start + 1) - start),
        AllOf(HasSubstr("'lamp.obj' not found"), HasSubstr("--scenes-dir"), Not(HasSubstr(folder_.path.string()))));
}

TEST_F(ReproduceCommand, WhatWasFinishedBeforeIsNotMeasuredAgain) {
    ASSERT_EQ(reproduce({file("trial.toml")}).exit_code, 0);
    // No clock would tell it: what is measured again would not show it.
    nlohmann::json measurements = nlohmann::json::parse(written("measurements.json"));
    measurements["started"] = "once upon a time";
    write("out/trial/measurements.json", measurements.dump());
    const ProgramRun second = reproduce({file("trial.toml")});
    EXPECT_EQ(second.exit_code, 0) << second.output;
    EXPECT_THAT(second.output, AllOf(HasSubstr("measured before (once upon a time)"), Not(HasSubstr("Disk:"))));
    EXPECT_THAT(written("README.md"), HasSubstr("once upon a time"));

    EXPECT_THAT(reproduce({file("trial.toml"), "--again"}).output, Not(HasSubstr("measured before")));
    write("trial.toml", std::string(experiment) + "[reference]\nseed = 7\n");
    EXPECT_THAT(reproduce({file("trial.toml")}).output, Not(HasSubstr("measured before"))) << "another experiment";
    EXPECT_THAT(reproduce({file("trial.toml")}).output, HasSubstr("measured before"));
}

TEST_F(ReproduceCommand, AnExperimentOfTheLiteratureIsWhole) {
    const ProgramRun run = reproduce({"thesis-drawings"});
    ASSERT_EQ(run.exit_code, 0) << run.output;
    for (const char* name : {"figure-1.svg", "figure-1.png", "figure-1.csv", "README.md"})
        EXPECT_GT(std::filesystem::file_size(folder_.path / "out/thesis-drawings" / name), 0u) << name;
}

}  // namespace
}  // namespace plumb

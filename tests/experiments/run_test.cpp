// A whole experiment at thumbnail size, from the command line to the page.
#include <algorithm>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "frames/exr.h"
#include "tests/experiments/program.h"
#include "tests/experiments/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* experiment = R"(title = "A thumbnail"
planes = ["ao", "indirect"]
resolution = [64, 36]
methods = ["one_layer", "two_layers"]
path_tracer_samples = [2]
[reference]
samples = 16
[timing]
repetitions = 2
[[scenes]]
scene = "cornell"
views = ["front"]
ao_radius = 0.1
indirect_radius = 0.3
minimum_separation = 0.03
[[scenes]]
scene = "no_such_scene"
)";

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

class Run : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = new TemporaryFolder;
        std::ofstream(folder_->path / "thumbnail.toml") << experiment;
        first_ = run_it("first");
    }
    static void TearDownTestSuite() {
        delete folder_;
        folder_ = nullptr;
    }
    static ProgramRun run_it(const std::string& output) {
        return run_plumbline({"run", (folder_->path / "thumbnail.toml").string(), "--output",
                              (folder_->path / output).string(), "--cache-dir", (folder_->path / "cache").string()});
    }
    static nlohmann::json results(const std::string& output) {
        return nlohmann::json::parse(text_of(folder_->path / output / "results.json"));
    }
    static TemporaryFolder* folder_;
    static ProgramRun first_;
};

TemporaryFolder* Run::folder_ = nullptr;
ProgramRun Run::first_;

TEST_F(Run, PrintsTableSummaryAndPathsAndListsTheSceneThatFailed) {
    EXPECT_EQ(first_.exit_code, 1) << "one scene does not exist\n" << first_.output;
    EXPECT_THAT(first_.output, AllOf(HasSubstr("RMSE [95 %]"), HasSubstr("two_layers"), HasSubstr("index.html"),
                                     HasSubstr("1 cell failed"), HasSubstr("no_such_scene")));
}

TEST_F(Run, WritesARowForEveryCellOfTheSceneThatWorks) {
    const auto json = results("first");
    // ao has one truth, indirect two; two methods each; one point of the path tracer's curve per plane.
    EXPECT_EQ(json["rows"].size(), 2u * (1 + 2) + 2u);
    for (const auto& row : json["rows"]) EXPECT_GT(row["milliseconds"]["median"], 0.0) << row.dump();
    EXPECT_EQ(json["failures"].size(), 1u);
    EXPECT_EQ(json["experiment"]["resolution"], nlohmann::json({64, 36}));
    const std::string csv = text_of(folder_->path / "first/results.csv");
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(csv, '\n')), json["rows"].size() + 1);
}

TEST_F(Run, WritesFramesPicturesAndThePage) {
    const auto out = folder_->path / "first";
    const Frame truth = read_exr(out / "frames/cornell.front.truth.exr");
    EXPECT_TRUE(truth.has("half_b.indirect"));
    EXPECT_TRUE(read_exr(out / "frames/cornell.front.two_layers.exr").has("ao"));
    EXPECT_TRUE(std::filesystem::exists(out / "pictures/cornell.front.ao.two_layers.error.png"));
    const std::string page = text_of(out / "index.html");
    EXPECT_THAT(page, AllOf(HasSubstr("A thumbnail"), HasSubstr("data:image/png;base64,"), HasSubstr("no_such_scene")));
}

TEST_F(Run, ASecondRunReadsItsTruthsAndFindsTheSameErrors) {
    const ProgramRun second = run_it("second");
    EXPECT_THAT(second.output, HasSubstr("2 truths (2 of them from the cache)"));
    const auto a = results("first"), b = results("second");
    ASSERT_EQ(a["rows"].size(), b["rows"].size());
    for (std::size_t i = 0; i < a["rows"].size(); ++i) {
        EXPECT_EQ(a["rows"][i]["measures"], b["rows"][i]["measures"]) << a["rows"][i]["method"];
    }
}

TEST_F(Run, ADamagedCacheIsReportedAndRepaired) {
    for (const auto& entry : std::filesystem::directory_iterator(folder_->path / "cache")) {
        if (entry.path().extension() == ".exr") std::filesystem::resize_file(entry.path(), 1000);
    }
    const ProgramRun run = run_it("third");
    EXPECT_THAT(run.output, AllOf(HasSubstr("rendering it again"), HasSubstr("2 truths (0 of them from the cache)")));
    EXPECT_EQ(results("first")["rows"][0]["measures"], results("third")["rows"][0]["measures"]);
}

}  // namespace
}  // namespace plumb

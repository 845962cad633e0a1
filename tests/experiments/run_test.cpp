// A whole experiment at thumbnail size, from the command line to the page.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "frames/exr.h"
#include "tests/experiments/program.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* experiment = R"(title = "A thumbnail"
planes = ["ao", "indirect"]
resolution = [64, 36]
methods = ["one_layer", "two_layers", {name = "few", base = "one_layer", sweep = {"ao.samples" = [4, 8]}}]
path_tracer_samples = [2]
oracle = [1]
oracle_bounces = [1, 2]
seeds = 3
[quantities]
bounces = 3
[reference]
samples = 16
path_samples = 8
[timing]
repetitions = 2
[[scenes]]
scene = "cornell"
views = ["front"]
ao_radius = 0.1
indirect_radius = 0.3
minimum_separation = 0.03
[[scenes.paths]]
path = "strafe"
start = 0.25
frames = 3
[[scenes]]
scene = "no_such_scene"
)";

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

bool is_oracle(const nlohmann::json& row) { return row.contains("oracle_layers") || row.contains("oracle_bounces"); }

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
    // ao has one truth, indirect two; four methods each; for either plane one point of the path tracer's curve and the
    // oracle of one layer, and for indirect those of bounces; then each plane and method along the path, and the
    // oracles.
    EXPECT_EQ(json["rows"].size(), 4u * (1 + 2) + 2u + (2u + 2u) + 2u * (4u + 1u) + 2u);
    for (const auto& row : json["rows"]) {
        if (is_oracle(row)) continue;  // takes no time
        EXPECT_GT(row["milliseconds"]["median"], 0.0) << row.dump();
        if (!row.contains("path_tracer_samples")) continue;
        EXPECT_EQ(row["milliseconds"]["repetitions"], 2) << "timed as often as the methods";
        EXPECT_LE(row["milliseconds"]["lower_quartile"], row["milliseconds"]["median"]);
        EXPECT_LE(row["milliseconds"]["median"], row["milliseconds"]["upper_quartile"]);
    }
    for (const auto& row : json["rows"]) {
        const bool of_seeds = row.contains("parameters") && !row.contains("path");
        ASSERT_EQ(row.contains("seeds"), of_seeds) << row.dump();
        if (!of_seeds) continue;
        EXPECT_EQ(row["seeds"]["pictures"], 3);
        EXPECT_LT(row["seeds"]["unbiased_mse_lower"], row["seeds"]["unbiased_mse_upper"]) << row.dump();
    }
    EXPECT_EQ(json["failures"].size(), 1u);
    EXPECT_EQ(json["experiment"]["resolution"], nlohmann::json({64, 36}));
    const std::string csv = text_of(folder_->path / "first/results.csv");
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(csv, '\n')), json["rows"].size() + 1);
    std::size_t regions = 0;
    for (const auto& row : json["rows"]) regions += row.value("regions", nlohmann::json::object()).size();
    EXPECT_GT(regions, json["rows"].size());
    const std::string regions_csv = text_of(folder_->path / "first/regions.csv");
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(regions_csv, '\n')), regions + 1);
}

TEST_F(Run, TheOracleKnowsBetterThanTheMethodsAndSweepsTellTheirPoints) {
    const auto json = results("first");
    double oracle = 0.0, method = 0.0;
    std::vector<double> swept;
    for (const auto& row : json["rows"]) {
        if (row["plane"] != "ao" || row.contains("path")) continue;
        if (row.contains("oracle_layers")) oracle = row["measures"]["rmse"];
        if (row["method"] == "one_layer") method = row["measures"]["rmse"];
        if (row.contains("sweep")) swept.push_back(row["sweep"]["value"]);
    }
    EXPECT_GT(oracle, 0.0);
    EXPECT_LT(oracle, method) << "no method sees more than the oracle";
    EXPECT_EQ(swept, (std::vector{4.0, 8.0}));
}

// It takes the samples of the truth and leaves light away: a pixel is nowhere brighter, and all that lacks is bias.
TEST_F(Run, TheOracleOfFewerBouncesIsTheTruthLessTheLightOfFurtherOnes) {
    const auto json = results("first");
    for (const bool along_path : {false, true}) {
        std::map<int, double> lacking;
        for (const auto& row : json["rows"]) {
            if (!row.contains("oracle_bounces") || row.contains("path") != along_path) continue;
            EXPECT_EQ(row["plane"], "indirect");
            EXPECT_EQ(row["truth"], "full") << "its light has no limit";
            const int bounces = row["oracle_bounces"];
            EXPECT_EQ(row["method"], fmt::format("oracle, {} bounce{}", bounces, bounces == 1 ? "" : "s"));
            const double bias = row["measures"]["bias"], mae = row["measures"]["mae"];
            // Sums of three bounces and of two, each rounded to float: 1e-7 of a value each, which bias takes off.
            EXPECT_NEAR(mae, -bias, 1e-6 * row["measures"]["reference_mean"].get<double>()) << row.dump();
            lacking[bounces] = -bias / row["measures"]["reference_mean"].get<double>();
        }
        ASSERT_EQ(lacking.size(), 2u);
        EXPECT_GT(lacking.at(2), 0.02) << "the third bounce in a room that reflects half of its light";
        EXPECT_GT(lacking.at(1), 2.0 * lacking.at(2));
        EXPECT_LT(lacking.at(1), 0.8);
    }
}

TEST_F(Run, APathHasAnErrorForEachFrameAFlickerBetweenThemAndPictures) {
    const auto json = results("first");
    int paths = 0;
    for (const auto& row : json["rows"]) {
        if (!row.contains("path")) continue;
        ++paths;
        ASSERT_EQ(row["frames"].size(), 3u) << row.dump();
        EXPECT_DOUBLE_EQ(row["frames"][1]["time"], 0.25 + 1.0 / 30.0);
        EXPECT_TRUE(row["frames"][0]["flicker"].is_null()) << "nothing came before the first frame";
        EXPECT_GT(row["stability"]["method_warping"], 0.0);
        if (is_oracle(row)) {
            EXPECT_EQ(row["milliseconds"]["median"], 0.0) << "no program can be it";
        } else {
            EXPECT_GT(row["frames"][2]["rmse"], 0.0);
            EXPECT_EQ(row["milliseconds"]["repetitions"], 2 * 3) << "every frame of two plays";
        }
        EXPECT_TRUE(row["regions"].contains("border"));
    }
    EXPECT_EQ(paths, 2 * (4 + 1) + 2) << "methods and the oracles";
    int pictures = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_->path / "first/pictures"))
        pictures += entry.path().extension() == ".jpg";
    // Per frame and plane: the truth, and each method with its error map.
    EXPECT_EQ(pictures, 3 * 2 * (1 + 2 * 4));
}

// Of a filter that keeps the share alpha: alpha / (1 - alpha) frames (metrics/path_lag.h).
TEST_F(Run, TheTemporalFilterLagsAsItsWeightsSayWhereTheLampMoves) {
    std::ofstream(folder_->path / "lag.toml") << R"(planes = ["indirect"]
resolution = [64, 36]
path_tracer_samples = []
methods = [{name = "filter", base = "one_layer", sweep = {"radiosity.temporal.alpha" = [0.5, 0.8]}}]
[measures]
flip = "none"
[reference]
samples = 2
path_samples = 128
[[scenes]]
scene = "cornell-moving-lamp"
views = ["front"]
ao_radius = 0.1
indirect_radius = 0.3
method.radiosity.temporal.vary_taps = false
[[scenes.paths]]
path = "standing-front"
frames = 3
[[scenes.paths]]
path = "strafe"
frames = 2
)";
    const std::vector<std::string> command = {"run",         (folder_->path / "lag.toml").string(),
                                              "--output",    (folder_->path / "lag").string(),
                                              "--cache-dir", (folder_->path / "cache").string()};
    const ProgramRun run = run_plumbline(command);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    int lags = 0;
    const auto json = results("lag");
    for (const auto& row : json["rows"]) {
        const bool standing = row.contains("path") && row["path"] == "standing-front";
        ASSERT_EQ(row.contains("lag"), standing) << "of a moving camera there is none";
        if (!standing) continue;
        ++lags;
        // The taps are the same in every frame, so that nothing but the weights shows; half floats keep history to a
        // thousandth, and thirds of what is left over some 70 frames to some hundredths of a frame.
        EXPECT_NEAR(row["lag"]["frames"].get<double>(), row["sweep"]["value"] == 0.5 ? 1.0 : 4.0, 0.1) << row["lag"];
        EXPECT_LE(row["lag"]["lower"], row["lag"]["upper"]);
    }
    EXPECT_EQ(lags, 2);
}

TEST_F(Run, IsRepeatedBitForBitFromItsResults) {
    const auto record = folder_->path / "first/results.json";
    const ProgramRun again = run_plumbline({"run", record.string(), "--output", (folder_->path / "again").string(),
                                            "--cache-dir", (folder_->path / "another cache").string()});
    EXPECT_EQ(again.exit_code, 1) << "the scene that does not exist still does not\n" << again.output;
    EXPECT_THAT(again.output, HasSubstr("30 of 30 rows are as recorded, bit for bit"));

    // One thing of a row each, but for one whose time alone is another.
    auto forged = results("first");
    auto& rows = forged["rows"];
    rows[0]["measures"]["mse"] = 0.125;
    rows[1]["unbiased_mse"]["upper"] = 0.125;
    rows[2]["regions"]["border"]["lower"] = 0.125;
    rows[3]["seeds"]["unbiased_mse_lower"] = 0.125;
    rows[4]["milliseconds"]["median"] = 0.125;
    auto& of_path = rows[rows.size() - 1];
    of_path["frames"][1]["flicker"] = 0.125;
    rows[rows.size() - 2]["stability"]["flicker_upper"] = 0.125;
    std::ofstream(folder_->path / "forged.json") << forged;
    const ProgramRun apart =
        run_plumbline({"run", (folder_->path / "forged.json").string(), "--output", (folder_->path / "apart").string(),
                       "--cache-dir", (folder_->path / "cache").string()});
    EXPECT_EQ(apart.exit_code, 1);
    EXPECT_THAT(apart.output,
                AllOf(HasSubstr("24 of 30 rows"), HasSubstr("measures.mse was 0.125"),
                      HasSubstr("unbiased_mse.upper was 0.125"), HasSubstr("border.lower was 0.125"),
                      HasSubstr("seeds.unbiased_mse_lower was 0.125"), HasSubstr("frames.1.flicker was 0.125"),
                      HasSubstr("stability.flicker_upper was 0.125")));
}

// Not what was being written when a run was killed: such files are hidden.
std::vector<std::filesystem::path> kept_cells(const std::filesystem::path& cells) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(cells)) {
        const std::filesystem::path& file = entry.path();
        if (file.extension() == ".exr" && !file.filename().string().starts_with('.')) files.push_back(file);
    }
    return files;
}

// Gives every kept cell of a view times that no clock would tell, so that what is taken from a cell can be told from
// what is measured again. Returns these times.
std::vector<double> mark_cells(const std::filesystem::path& cells) {
    std::vector<double> times;
    for (const std::filesystem::path& cell : kept_cells(cells)) {
        Frame frame = read_exr(cell);
        nlohmann::json images = nlohmann::json::parse(frame.facts.at("cell.images"));
        if (images[0]["view"] != "front") continue;  // a path's frames are used all or not at all
        for (auto& image : images) image["timing"][0] = times.emplace_back(1e6 + static_cast<double>(times.size()));
        frame.facts["cell.images"] = images.dump();
        write_exr(cell, frame);
    }
    return times;
}

TEST_F(Run, GoesOnWithTheCellsOfARunThatWasKilled) {
    // Killed once the first cell is kept: what is rendered at any time before the end.
    const auto out = folder_->path / "killed";
    const std::string command = fmt::format(
        "'{}' run '{}' --output '{}' --cache-dir '{}' >/dev/null 2>&1 & p=$!; "
        "for i in $(seq 600); do ls '{}'/cells/*.exr >/dev/null 2>&1 && break; sleep 0.02; done; kill -9 $p; wait $p",
        PLUMBLINE_PROGRAM, (folder_->path / "thumbnail.toml").string(), out.string(),
        (folder_->path / "cache").string(), out.string());
    std::ignore = std::system(command.c_str());
    ASSERT_TRUE(std::filesystem::exists(out / "cells")) << "the run was not killed in its middle";
    EXPECT_FALSE(std::filesystem::exists(out / "results.json"));
    std::ofstream half_written(out / "cells" / ".half.1-1.tmp.exr");  // as a kill amid writing leaves one
    half_written.close();
    const std::vector<double> marked = mark_cells(out / "cells");
    ASSERT_FALSE(marked.empty());
    run_it("killed");
    EXPECT_FALSE(std::filesystem::exists(out / "cells")) << "finished runs need no cells";
    const auto a = results("first"), b = results("killed");
    std::set<double> times;
    for (const auto& row : b["rows"]) times.insert(row["milliseconds"]["median"].get<double>());
    for (const double time : marked) EXPECT_TRUE(times.contains(time)) << "a kept cell was rendered and timed again";
    ASSERT_EQ(a["rows"].size(), b["rows"].size());
    for (std::size_t i = 0; i < a["rows"].size(); ++i) EXPECT_EQ(a["rows"][i]["measures"], b["rows"][i]["measures"]);
}

TEST_F(Run, WhatFailsOnTheWayDoesNotEndItAndIsListedWithItsCause) {
    std::ofstream(folder_->path / "failing.toml") << R"(planes = ["ao", "indirect"]
resolution = [32, 18]
methods = ["one_layer", {name = "dark", base = "one_layer", ao.enabled = false}]
path_tracer_samples = []
[reference]
samples = 4
[timing]
repetitions = 1
[[scenes]]
scene = "cornell"
views = ["nowhere", "front"]
paths = [{path = "astray", frames = 2}, {path = "strafe", frames = 2}]
)";
    const ProgramRun run =
        run_plumbline({"run", (folder_->path / "failing.toml").string(), "--output",
                       (folder_->path / "failing").string(), "--cache-dir", (folder_->path / "cache").string()});
    EXPECT_EQ(run.exit_code, 1) << run.output;
    const std::string last = run.output.substr(std::min(run.output.size(), run.output.find("cells failed:")));
    // A view, a path, and a method that does not make the plane that is asked for: in views and along the path.
    EXPECT_THAT(last, AllOf(HasSubstr("cornell / nowhere / reference: "), HasSubstr("it has: front"),
                            HasSubstr("cornell / astray: "), HasSubstr("cornell / ao / dark: "),
                            HasSubstr("cornell / strafe / ao / dark: ")))
        << run.output;
    const auto json = results("failing");
    EXPECT_EQ(json["failures"].size(), 4u);
    std::set<std::string> rows;
    for (const auto& row : json["rows"])
        rows.insert(fmt::format("{} {} {}", row.value("path", row["view"].get<std::string>()),
                                row["plane"].get<std::string>(), row["method"].get<std::string>()));
    EXPECT_THAT(rows, testing::ElementsAre("front ao one_layer", "front indirect dark", "front indirect one_layer",
                                           "strafe ao one_layer", "strafe indirect dark", "strafe indirect one_layer"));
}

// Two scenes with a path each; methods with a history.
std::string two_paths(int repetitions) {
    return fmt::format(R"(planes = ["ao"]
resolution = [32, 18]
methods = ["one_layer", {{name = "steady", base = "one_layer", ao.temporal.alpha = 0.9}},
           {{name = "fed", base = "two_layers", gbuffer.source = "truth"}}]
path_tracer_samples = []
[reference]
samples = 4
path_samples = 4
[timing]
repetitions = {}
[[scenes]]
scene = "cornell"
views = ["front"]
paths = [{{path = "strafe", frames = 3}}]
[[scenes]]
scene = "clutter"
views = ["shelf"]
paths = [{{path = "strafe", frames = 3}}]
)",
                       repetitions);
}

TEST_F(Run, TimesLeaveNoTraceInWhatAPathShows) {
    std::map<int, nlohmann::json> rows;
    for (const int repetitions : {1, 9}) {
        const std::string name = fmt::format("timed{}", repetitions);
        std::ofstream(folder_->path / (name + ".toml")) << two_paths(repetitions);
        const ProgramRun run =
            run_plumbline({"run", (folder_->path / (name + ".toml")).string(), "--output",
                           (folder_->path / name).string(), "--cache-dir", (folder_->path / "cache").string()});
        ASSERT_EQ(run.exit_code, 0) << run.output;
        rows[repetitions] = results(name)["rows"];
        for (auto& row : rows[repetitions]) {
            if (row.contains("path")) {
                EXPECT_EQ(row["milliseconds"]["repetitions"], repetitions == 1 ? 6 : 9) << row["method"];
            }
            row.erase("milliseconds");
        }
    }
    EXPECT_EQ(rows[1], rows[9]);
}

TEST_F(Run, TakesAPathsTimesFromTheCellsOfARunThatWasKilled) {
    // Killed once all cells of the first scene are kept: one of its view and three of its path.
    std::ofstream(folder_->path / "paths.toml") << two_paths(1);
    const auto out = folder_->path / "paths";
    const std::string command = fmt::format(
        "'{}' run '{}' --output '{}' --cache-dir '{}' >/dev/null 2>&1 & p=$!; "
        "for i in $(seq 3000); do [ $(ls '{}'/cells/*.exr 2>/dev/null | wc -l) -ge 4 ] && break; sleep 0.01; done; "
        "kill -9 $p; wait $p",
        PLUMBLINE_PROGRAM, (folder_->path / "paths.toml").string(), out.string(), (folder_->path / "cache").string(),
        out.string());
    std::ignore = std::system(command.c_str());
    ASSERT_TRUE(std::filesystem::exists(out / "cells")) << "the run was not killed in its middle";
    int marked = 0;
    for (const std::filesystem::path& cell : kept_cells(out / "cells")) {
        Frame frame = read_exr(cell);
        nlohmann::json images = nlohmann::json::parse(frame.facts.at("cell.images"));
        if (images[0]["timing"][0] == 0.0 || images[0]["view"] != "strafe") continue;
        ++marked;
        for (auto& image : images) image["timing"][0] = 1e6;
        frame.facts["cell.images"] = images.dump();
        write_exr(cell, frame);
    }
    EXPECT_EQ(marked, 1) << "the first frame's cell has the times of all";
    run_plumbline({"run", (folder_->path / "paths.toml").string(), "--output", out.string(), "--cache-dir",
                   (folder_->path / "cache").string()});
    for (const auto& row : results("paths")["rows"]) {
        if (row["scene"] != "cornell" || !row.contains("path")) continue;
        EXPECT_EQ(row["milliseconds"]["median"], 1e6) << row["method"] << " was timed again";
    }
}

TEST_F(Run, WritesFramesPicturesAndThePage) {
    const auto out = folder_->path / "first";
    const Frame truth = read_exr(out / "frames/cornell.front.truth.exr");
    EXPECT_TRUE(truth.has("half_b.indirect"));
    EXPECT_TRUE(read_exr(out / "frames/cornell.front.two_layers.exr").has("ao"));
    EXPECT_TRUE(std::filesystem::exists(out / "pictures/cornell.front.ao.two_layers.error.png"));
    const std::string page = text_of(out / "index.html");
    EXPECT_THAT(page, AllOf(HasSubstr("A thumbnail"), HasSubstr("no_such_scene")));
    EXPECT_THAT(text_of(out / "headline.md"), AllOf(HasSubstr("|  | ao: 1 view | ao: 1 path |"),
                                                    HasSubstr("| in practice, two_layers over one_layer: RMSE |")));
    // The values of every truth's and method's picture are within the page, the last with an element that is not empty.
    std::ptrdiff_t planes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(out / "pictures"))
        planes += entry.path().extension() == ".plane";
    ASSERT_GT(planes, 0);
    const std::string last = fmt::format("id=\"values-{}\">", planes - 1);
    ASSERT_THAT(page, HasSubstr(last));
    EXPECT_NE(page[page.find(last) + last.size()], '<');
}

TEST_F(Run, ASecondRunReadsItsTruthsAndFindsTheSameErrors) {
    const ProgramRun second = run_it("second");
    EXPECT_THAT(second.output, HasSubstr("17 truths (17 of them from the cache)"));
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
    EXPECT_THAT(run.output, AllOf(HasSubstr("rendering it again"), HasSubstr("17 truths (0 of them from the cache)")));
    EXPECT_EQ(results("first")["rows"][0]["measures"], results("third")["rows"][0]["measures"]);
}

}  // namespace
}  // namespace plumb

#include "experiments/ladder.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/experiments/sample_results.h"
#include "tests/message_of.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string experiment_text = R"(planes = ["ao"]
oracle = [0]
methods = ["one_layer", "two_layers"]
[[scenes]]
scene = "cornell"
[[ladders]]
plane = "ao"
rungs = ["oracle, all in view", "two_layers"]
)";

Experiment parse(const std::string& text) { return parse_experiment(parse_config(text, "e.toml"), "e.toml"); }

TEST(Ladder, ReadsItsRungsAndRefusesThoseThatAreNotCompared) {
    const auto ladders = read_ladders(parse(experiment_text));
    ASSERT_EQ(ladders.size(), 1u);
    EXPECT_THAT(ladders[0].rungs, testing::ElementsAre("oracle, all in view", "two_layers"));
    const auto failure = [](std::string text, const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
        return message_of<ConfigError>([&] { parse(text); });
    };
    EXPECT_THAT(failure(experiment_text, "in view\", \"two_layers", "in view\", \"two_layres"),
                AllOf(HasSubstr("e.toml:8"), HasSubstr("did you mean 'two_layers'?")));
    EXPECT_THAT(failure(experiment_text, "plane = \"ao\"", "plane = \"total\""), HasSubstr("is not compared"));
    EXPECT_THAT(failure(experiment_text, "oracle = [0]", "oracle = [1]"), HasSubstr("oracle, all in view"));
}

TEST(Ladder, OraclesOfFewerBouncesAreRungsToo) {
    const auto ladders = read_ladders(parse(R"(planes = ["indirect"]
oracle_bounces = [1]
methods = ["one_layer"]
[quantities]
bounces = 3
[[scenes]]
scene = "cornell"
[[ladders]]
plane = "indirect"
rungs = ["oracle, 1 bounce", "one_layer"]
)"));
    ASSERT_EQ(ladders.size(), 1u);
    EXPECT_EQ(ladders[0].rungs[0], "oracle, 1 bounce");
}

TEST(Ladder, OraclesAreRungsOfPathsToo) {
    const auto ladders = read_ladders(parse(experiment_text + "paths = true\n"));
    ASSERT_EQ(ladders.size(), 1u);
    EXPECT_TRUE(ladders[0].paths);
    EXPECT_EQ(ladders[0].rungs[0], "oracle, all in view");
}

TEST(Ladder, TheShippedOneCanBeReadAndHasBothQuantitiesInMotion) {
    const Experiment experiment = load_experiment(PLUMBLINE_SOURCE_DIR "/experiments/ladder.toml");
    std::vector<std::string> of_paths;
    for (const Ladder& ladder : read_ladders(experiment)) {
        if (ladder.paths) of_paths.push_back(ladder.plane);
    }
    EXPECT_THAT(of_paths, testing::ElementsAre("ao", "indirect"));
}

// Two rungs over three views: what the second adds is 0.05, 0.1 and 0.15.
RunResults results_of_rungs() {
    RunResults results = sample_results();
    results.rows.clear();
    results.experiment.scenes.emplace_back().scene = "cornell";
    const std::vector<std::string> views = {"front", "left", "right"};
    for (std::size_t i = 0; i < views.size(); ++i) {
        results.rows.push_back(sample_row(views[i], "one", 0.1, 4.0));
        results.rows.push_back(sample_row(views[i], "two", 0.15 + 0.05 * static_cast<double>(i), 1.0));
    }
    return results;
}

TEST(Ladder, SaysWhatEachRungAddsWithItsIntervalAndTheTimeItSaves) {
    const RunResults results = results_of_rungs();
    const Climb climbed = climb({{"visibility", "ao", {"one", "two"}, false}}, results);
    const auto& waterfalls = climbed.waterfalls;
    EXPECT_THAT(climbed.gaps, testing::IsEmpty());
    ASSERT_EQ(waterfalls.size(), 1u);
    const auto& bars = waterfalls[0].bars;
    ASSERT_EQ(bars.size(), 2u);
    EXPECT_DOUBLE_EQ(bars[0].from, 0.0) << "the truth has no error";
    EXPECT_NEAR(bars[0].to, 0.1, 1e-12);
    EXPECT_NEAR(bars[1].from, 0.1, 1e-12);
    EXPECT_NEAR(bars[1].to, 0.2, 1e-12);
    // Mean 0.1, standard deviation 0.05 of three: 0.05 / sqrt(3) times Student's 4.303 (two degrees of freedom, 97.5
    // %).
    EXPECT_NEAR(bars[1].change_upper, 0.1 + 4.3027 * 0.05 / std::sqrt(3.0), 1e-4);
    EXPECT_EQ(bars[1].note, "saves 3 ms");
    EXPECT_THAT(print_waterfalls(waterfalls), AllOf(HasSubstr("<svg"), HasSubstr("visibility")));
    EXPECT_THAT(print_waterfall_table(waterfalls), AllOf(HasSubstr("+0.1 ["), HasSubstr("saves 3 ms")));
}

TEST(Ladder, IsWrittenAsCsvWithTheNumbersOfEachRung) {
    const RunResults results = results_of_rungs();
    const std::string csv = print_waterfall_csv(climb({{"a, b", "ao", {"one", "two"}, false}}, results).waterfalls);
    EXPECT_THAT(csv, AllOf(testing::StartsWith("ladder,rung,rmse_above,rmse,adds,adds_lower,adds_upper,time\n"),
                           HasSubstr("\"cornell: a, b\",one,0,0.1,0.1,"), HasSubstr(",two,0.1,0.2,0.1,-0.024"),
                           HasSubstr(",saves 3 ms\n")));
}

TEST(Ladder, ARungThatWasRefusedIsPassedOverAndSaidWhy) {
    RunResults results = results_of_rungs();
    for (const char* view : {"front", "left", "right"}) {
        results.rows.push_back(sample_row(view, "between", 0.12, 2.0));
        results.rows.back().measured = false, results.rows.back().refusal = "4096 samples per pixel would do";
    }
    const Climb climbed = climb({{"visibility", "ao", {"one", "between", "two", "lost"}, false}}, results);
    ASSERT_EQ(climbed.waterfalls.size(), 1u);
    ASSERT_EQ(climbed.waterfalls[0].bars.size(), 2u);
    EXPECT_EQ(climbed.waterfalls[0].bars[1].label, "two");
    EXPECT_NEAR(climbed.waterfalls[0].bars[1].from, 0.1, 1e-12) << "its step is from the last rung that is told";
    EXPECT_THAT(climbed.gaps,
                testing::ElementsAre(AllOf(HasSubstr("'cornell: visibility'"), HasSubstr("rung 'between'"),
                                           HasSubstr("front: 4096 samples per pixel would do")),
                                     AllOf(HasSubstr("rung 'lost'"), HasSubstr("was not rendered"))));
}

TEST(Ladder, ItsBarsMeetBecauseAllAreOverTheViewsThatAllRungsHave) {
    RunResults results = results_of_rungs();
    results.rows[1].measured = false, results.rows[1].refusal = "too noisy";  // the second rung, in the first view
    const Climb climbed = climb({{"visibility", "ao", {"one", "two"}, false}}, results);
    ASSERT_EQ(climbed.waterfalls.size(), 1u);
    const auto& bars = climbed.waterfalls[0].bars;
    EXPECT_EQ(bars[0].to, bars[1].from);
    EXPECT_NEAR(bars[1].to, 0.225, 1e-12);
    EXPECT_THAT(climbed.gaps, testing::ElementsAre(AllOf(HasSubstr("'two' is measured in 2 of 3 views"),
                                                         HasSubstr("front: too noisy"))));
    results.rows[2].measured = results.rows[4].measured = false;  // the first rung, in the others
    const Climb nothing = climb({{"visibility", "ao", {"one", "two"}, false}}, results);
    EXPECT_TRUE(nothing.waterfalls.empty());
    EXPECT_THAT(nothing.gaps.back(), HasSubstr("left out, because its rungs share no measured view"));
}

}  // namespace
}  // namespace plumb

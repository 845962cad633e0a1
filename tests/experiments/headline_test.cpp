#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/headline_table.h"
#include "experiments/statistics.h"
#include "experiments/summary.h"
#include "tests/experiments/second_layer_sample.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// "| name | cell | cell |" of the table's row.
std::string line_of(const std::string& text, const std::string& name) {
    const std::size_t start = text.find(fmt::format("\n| {} |", name));
    return start == std::string::npos ? "" : text.substr(start + 1, text.find('\n', start + 1) - start - 1);
}

TEST(Headline, HasAColumnForViewsAndOneForPathsOfEachPlane) {
    RunResults results = second_layer_results();
    results.experiment.planes = {"indirect", "ao"};
    ResultRow limited = sample_row("front", "one", 0.1, 2.0);
    limited.plane = "indirect", limited.truth = "within 1 m";
    results.rows.push_back(limited);
    EXPECT_THAT(print_headline(results),
                HasSubstr("|  | indirect, truth limited to the method's radius: 1 view | ao: 3 views | ao: 3 paths |"));
}

TEST(Headline, TellsErrorFlickerAndTimeOfMethodsAndOracles) {
    const std::string text = print_headline(second_layer_results());
    EXPECT_EQ(line_of(text, "one: RMSE"), "| one: RMSE | 0.1 | 0.2 |");
    // The third root of 0.16 times 0.08 times 0.04.
    EXPECT_EQ(line_of(text, "two: RMSE"), "| two: RMSE | 0.05 | 0.08 |");
    EXPECT_EQ(line_of(text, "two: flicker"), "| two: flicker | - | 0.02 |");
    EXPECT_EQ(line_of(text, "two: ms"), "| two: ms | 4 | 3 |");
    // All in view was told in two views, and along no path.
    EXPECT_EQ(line_of(text, "oracle, 1 layer: RMSE"), "| oracle, 1 layer: RMSE | 0.04 (2 of 3 views) | 0.04 |");
    EXPECT_EQ(line_of(text, "oracle, 2 layers: flicker"), "| oracle, 2 layers: flicker | - | 0.004 |");
    EXPECT_THAT(text, AllOf(Not(HasSubstr("path tracer")), Not(HasSubstr("oracle, 1 layer: ms"))));
}

TEST(Headline, ItsRatiosHaveIntervalsAndTheNumberOfPlacesWhereSomeAreRefused) {
    const std::string text = print_headline(second_layer_results());
    EXPECT_EQ(line_of(text, "in practice, two over one: RMSE").substr(0, 53),
              "| in practice, two over one: RMSE | 0.50 [0.50, 0.50]");
    // Geometric mean 0.4; its interval over three paths.
    const RatioSummary paths = summarise_ratios({0.8, 0.4, 0.2});
    EXPECT_THAT(line_of(text, "in practice, two over one: RMSE"),
                HasSubstr(fmt::format("| 0.40 [{:.2f}, {:.2f}] |", paths.lower, paths.upper)));
    EXPECT_EQ(line_of(text, "in practice, two over one: flicker"),
              "| in practice, two over one: flicker | - | 0.50 [0.50, 0.50] |");
    EXPECT_EQ(line_of(text, "in practice, two over one: time"),
              "| in practice, two over one: time | 2.00 [2.00, 2.00] | 1.50 [1.50, 1.50] |");
    EXPECT_EQ(line_of(text, "in principle, oracle, 2 layers over oracle, 1 layer: RMSE"),
              "| in principle, oracle, 2 layers over oracle, 1 layer: RMSE | 0.50 [0.50, 0.50] | 0.50 [0.50, 0.50] |");
    EXPECT_EQ(line_of(text, "in principle, oracle, 2 layers over oracle, 1 layer: flicker"),
              "| in principle, oracle, 2 layers over oracle, 1 layer: flicker | - | 0.50 [0.50, 0.50] |");
    EXPECT_EQ(
        line_of(text, "in principle, oracle, all in view over oracle, 2 layers: RMSE"),
        "| in principle, oracle, all in view over oracle, 2 layers: RMSE | 0.50 (2 of 3 views: no interval) | - |");
}

TEST(Headline, TwoPlacesHaveNoInterval) {
    RunResults results = second_layer_results();
    std::erase_if(results.rows, [](const ResultRow& row) { return row.path == "orbit"; });
    EXPECT_EQ(line_of(print_headline(results), "in practice, two over one: RMSE"),
              "| in practice, two over one: RMSE | 0.50 [0.50, 0.50] | 0.40 (2 paths: no interval) |");
}

TEST(Headline, ShowsOnWhichSideOfOneAnIntervalEnds) {
    RunResults results = sample_results();
    const auto with_ratios = [&](double front, double left, double right) {
        results.rows[1].mse = std::pow(0.1 * front, 2);
        results.rows[3].mse = std::pow(0.1 * left, 2);
        results.rows[5].mse = std::pow(0.1 * right, 2);
        return line_of(print_headline(results), "in practice, two over one: RMSE");
    };
    // Logarithms of mean -0.03 and standard deviation 0.0125: Student's t of two, 4.303, takes the end to
    // -0.03 + 4.303 * 0.0125 / sqrt(3) = 0.00105; with 0.012, to -0.00019.
    const auto spread = [&](double by) {
        return with_ratios(std::exp(-0.03 - by), std::exp(-0.03), std::exp(-0.03 + by));
    };
    EXPECT_EQ(spread(0.0125), "| in practice, two over one: RMSE | 0.970 [0.941, 1.001] |");
    EXPECT_EQ(spread(0.012), "| in practice, two over one: RMSE | 0.9704 [0.9419, 0.9998] |");
    EXPECT_EQ(with_ratios(1.0, 1.0, 1.0), "| in practice, two over one: RMSE | 1.00 [1.00, 1.00] |");
}

TEST(Headline, EndsWithTheVerdicts) {
    const RunResults results = second_layer_results();
    const std::string text = print_headline(results);
    const std::vector<std::string> sentences = summarise(results);
    ASSERT_FALSE(sentences.empty());
    for (const std::string& sentence : sentences) EXPECT_THAT(text, HasSubstr("\n- " + sentence + "\n"));
    RunResults nothing;
    EXPECT_EQ(print_headline(nothing), "");
}

}  // namespace
}  // namespace plumb

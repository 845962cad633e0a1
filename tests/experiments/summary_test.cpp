#include "experiments/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/experiments/second_layer_sample.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(Summary, SaysWhatAMethodBuysAndCosts) {
    const auto sentences = summarise(sample_results());
    ASSERT_EQ(sentences.size(), 1u);
    EXPECT_THAT(sentences[0], AllOf(HasSubstr("ao: two has 0.50 times"), HasSubstr("over 3 views, lower in 3"),
                                    HasSubstr("2.00 times"), HasSubstr("50 % less error for 100 % more time")));
}

TEST(Summary, ClaimsNothingWhereTheIntervalIncludesOne) {
    RunResults results = sample_results();
    results.rows[1] = sample_row("front", "two", 0.2, 4.0);
    EXPECT_THAT(summarise(results)[0], HasSubstr("do not show that it changes the error"));
}

TEST(Summary, ClaimsNothingOfTwoViews) {
    RunResults results = sample_results();
    std::erase_if(results.rows, [](const ResultRow& row) { return row.view == "left"; });
    EXPECT_THAT(summarise(results)[0],
                AllOf(HasSubstr("0.50 times (of two cases: no interval) the RMSE of one over 2 views"),
                      HasSubstr("So few views have no interval: they do not show that it changes the error.")));
}

TEST(Summary, LeavesRefusedViewsOutAndCountsThem) {
    RunResults results = sample_results();
    results.rows[1].measured = false;
    EXPECT_THAT(summarise(results)[0], AllOf(HasSubstr("over 2 views"), HasSubstr("(1 more refused)")));
    for (ResultRow& row : results.rows) row.measured = false;
    EXPECT_THAT(summarise(results)[0], HasSubstr("no view allows a statement about two (3 refused)"));
}

TEST(Summary, TellsOfCameraPathsWithTheirFlicker) {
    const auto sentences = summarise(second_layer_results());
    ASSERT_EQ(sentences.size(), 5u) << "views, their two pairs of oracles, paths, and theirs";
    EXPECT_THAT(sentences[3],
                AllOf(HasSubstr("ao, along camera paths: two has 0.40 times"),
                      HasSubstr("0.50 times (95 % interval 0.50 to 0.50) the flicker of one over 3 paths"),
                      HasSubstr("lower in 3 of them"), HasSubstr("takes 1.50 times"),
                      HasSubstr("these paths do not show that it changes the error")));
    RunResults steady = second_layer_results();
    std::ranges::find_if(steady.rows, [](const ResultRow& row) {
        return row.stability && row.method == "two";
    })->stability->flicker.lower = 0.0;
    EXPECT_THAT(summarise(steady)[3], HasSubstr("the flicker (over 2 paths) of one over 3 paths"));
    for (ResultRow& row : steady.rows) {
        if (row.stability) row.stability->flicker.lower = 0.0;
    }
    EXPECT_THAT(summarise(steady)[3], Not(HasSubstr("flicker"))) << "the truth's noise leaves open whether it does";
}

TEST(Summary, TheTableStatesDataRangesAndRefusesFlickerThatIsLostInNoise) {
    RunResults results = second_layer_results();
    std::string table = print_results_table(results.rows);
    EXPECT_THAT(table, AllOf(HasSubstr("Peak of PSNR and data range of SSIM (of linear values): ao 1."),
                             HasSubstr(" 0.02 [0.018, 0.022]\n"), Not(HasSubstr(", flicker: not measured"))));
    for (ResultRow& row : results.rows) {
        row.data_range = row.view.empty() ? 0.5 : 0.25;
        if (row.stability) row.stability->trustworthy = false, row.stability->noise = 0.02;
    }
    table = print_results_table(results.rows);
    EXPECT_THAT(table, AllOf(HasSubstr(" 0.25 to 0.5"), HasSubstr("refused (1)"),
                             HasSubstr(", flicker: not measured: the truth's noise (RMS 0.02 from frame to frame)")));
    EXPECT_THAT(summarise(results)[3], Not(HasSubstr("flicker")));
}

TEST(Summary, SetsEachOracleAgainstTheOneWithFewerLayers) {
    RunResults results = second_layer_results();
    const auto sentences = summarise(results);
    EXPECT_EQ(
        sentences[1],
        "In principle, ao: the best possible RMSE of 'oracle, 2 layers' is 0.50 times (95 % interval 0.50 to 0.50) "
        "that of 'oracle, 1 layer', over 3 views.");
    EXPECT_THAT(sentences[2], AllOf(HasSubstr("'oracle, all in view' is 0.50 times (of two cases: no interval)"),
                                    HasSubstr("that of 'oracle, 2 layers', over 2 views")));
    EXPECT_THAT(sentences[4], AllOf(HasSubstr("along camera paths: the best possible"),
                                    HasSubstr(", its flicker 0.50 times"), HasSubstr("over 3 paths")));
    for (ResultRow& row : results.rows) row.measured = row.oracle.layers != 1;
    EXPECT_EQ(summarise(results)[1],
              "In principle, ao: no view allows a statement about 'oracle, 2 layers' against 'oracle, 1 layer'.");
}

TEST(ResultsTable, ShowsErrorsWithIntervalsAndRefusalsWithoutNumbers) {
    RunResults results = sample_results();
    results.rows[1].measured = false;
    results.rows[1].refusal = "4096 samples per pixel would do";
    const std::string table = print_results_table(results.rows);
    EXPECT_THAT(table, AllOf(HasSubstr("0.1 [0.09, 0.11]"), HasSubstr("2 [1.8, 2.2]"), HasSubstr("refused (1)"),
                             HasSubstr("cornell / front / ao / two: 4096 samples per pixel would do")));
    EXPECT_THAT(print_results_table({results.rows[1]}), Not(HasSubstr("0.05")))
        << "a refused comparison prints no error";
}

}  // namespace
}  // namespace plumb

#include "experiments/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/experiments/sample_results.h"

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

TEST(Summary, LeavesRefusedViewsOutAndCountsThem) {
    RunResults results = sample_results();
    results.rows[1].measured = false;
    EXPECT_THAT(summarise(results)[0], AllOf(HasSubstr("over 2 views"), HasSubstr("(1 more refused)")));
    for (ResultRow& row : results.rows) row.measured = false;
    EXPECT_THAT(summarise(results)[0], HasSubstr("no view allows a statement about two (3 refused)"));
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

// Verdicts on hand-made cells: every figure below can be worked out on paper.
#include "experiments/claims.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/claims_report.h"
#include "frames/atomic_file.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::HasSubstr;

Cell cell_with(const std::string& scene, const std::string& place, const std::string& method, double rmse) {
    Cell cell{scene, place, "ao", "", method, ""};
    cell.set("rmse", rmse);
    return cell;
}

Selector method_named(const std::string& name) {
    Selector selector;
    selector.wanted["method"] = {name};
    return selector;
}

Claim ratio_claim(std::optional<double> above, std::optional<double> below) {
    Claim claim;
    claim.claim = "two is better", claim.source = "000, section 1", claim.test = "RMSE, two over one";
    claim.quantity = {"rmse", QuantityKind::ratio, {}, method_named("two"), method_named("one")};
    claim.above = above, claim.below = below;
    return claim;
}

// Views of one scene, with the ratios of "two" to "one" given.
std::vector<Cell> cells_with_ratios(const std::string& scene, const std::vector<double>& ratios) {
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
        const std::string view = "view " + std::string(1, static_cast<char>('a' + i));
        cells.push_back(cell_with(scene, view, "one", 0.1));
        cells.push_back(cell_with(scene, view, "two", 0.1 * ratios[i]));
    }
    return cells;
}

std::vector<Cell> operator+(std::vector<Cell> a, const std::vector<Cell>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

TEST(Claims, RatiosPairCellsOfTheSameViewAndAverageGeometrically) {
    const Measured measured = measure_quantity(cells_with_ratios("room", {0.5, 2.0}), ratio_claim({}, 1.0).quantity);
    ASSERT_EQ(measured.cases.size(), 2u);
    EXPECT_EQ(measured.cases[1].place, "view b");
    EXPECT_DOUBLE_EQ(measured.cases[1].value, 2.0);
    EXPECT_NEAR(measured.summary.mean, 1.0, 1e-12);  // the root of 0.5 * 2
    // Two logarithms +-ln 2: standard error ln 2, and 12.706 for one degree of freedom.
    EXPECT_NEAR(measured.summary.upper, std::exp(12.706 * std::log(2.0)), 1e-6 * measured.summary.upper);
}

TEST(Claims, HoldsWhereTheIntervalLiesWithinTheRange) {
    const auto result = judge_claim(ratio_claim({}, 1.0), cells_with_ratios("room", {0.5, 0.52, 0.48, 0.5}));
    EXPECT_EQ(result.verdict, ClaimVerdict::holds) << result.reason;
    EXPECT_EQ(result.reason, "");
}

TEST(Claims, FailsWhereTheIntervalLiesOutsideTheRange) {
    EXPECT_EQ(judge_claim(ratio_claim({}, 1.0), cells_with_ratios("room", {1.5, 1.52, 1.48})).verdict,
              ClaimVerdict::fails);
    EXPECT_EQ(judge_claim(ratio_claim(2.0, {}), cells_with_ratios("room", {1.5, 1.52, 1.48})).verdict,
              ClaimVerdict::fails);
    EXPECT_EQ(judge_claim(ratio_claim(1.4, 1.6), cells_with_ratios("room", {1.5, 1.52, 1.48})).verdict,
              ClaimVerdict::holds);
}

TEST(Claims, DependsOnTheViewWhereTheIntervalIncludesTheBound) {
    const auto result = judge_claim(ratio_claim({}, 1.0), cells_with_ratios("room", {0.7, 1.2, 0.9}));
    EXPECT_EQ(result.verdict, ClaimVerdict::depends);
    EXPECT_EQ(result.reason, "on the view: holds in 2 of 3");
}

TEST(Claims, IsNotDecidedWhereTheIntervalIncludesTheBoundThoughAllCasesAgree) {
    const auto all = judge_claim(ratio_claim({}, 1.0), cells_with_ratios("room", {0.3, 0.9, 0.95}));
    EXPECT_EQ(all.verdict, ClaimVerdict::undecided);
    EXPECT_THAT(all.reason, HasSubstr("holds in all of 3 cases"));
    const auto none = judge_claim(ratio_claim(1.0, {}), cells_with_ratios("room", {0.3, 0.9}));
    EXPECT_EQ(none.verdict, ClaimVerdict::undecided);
    EXPECT_THAT(none.reason, HasSubstr("holds in none of 2 cases"));
    EXPECT_EQ(to_string(none.verdict), "not decided");
}

TEST(Claims, TwoCasesOfASceneStandInPlaceOfTheirInterval) {
    const Claim claim = ratio_claim({}, 1.0);
    const Measured measured = measure_quantity(
        cells_with_ratios("room", {0.5, 2.0}) + cells_with_ratios("hall", {0.5, 0.5, 0.5}), claim.quantity);
    EXPECT_EQ(scene_text(claim, measured, "room"), "1 times (2 cases: 0.5, 2)");
    EXPECT_EQ(scene_text(claim, measured, "hall"), "0.5 times [0.5, 0.5]");
}

TEST(Claims, DependsOnTheSceneAndSaysWhich) {
    const auto cells = cells_with_ratios("room", {0.5, 0.51, 0.49}) + cells_with_ratios("hall", {1.5, 1.51, 1.49});
    const auto result = judge_claim(ratio_claim({}, 1.0), cells);
    EXPECT_EQ(result.verdict, ClaimVerdict::depends);
    EXPECT_THAT(result.reason, HasSubstr("on the scene: holds in room (0.5 times ["));
    EXPECT_THAT(result.reason, HasSubstr("; not in hall (1.5 times ["));
}

// Nine views of ten hold so clearly that the mean does; the one scene that contradicts is still told.
TEST(Claims, ASceneThatFailsByItsOwnIntervalIsNotOutvoted) {
    const auto cells = cells_with_ratios("room", {0.1, 0.101, 0.099, 0.1, 0.1, 0.1, 0.1, 0.1}) +
                       cells_with_ratios("hall", {1.1, 1.101, 1.099});
    const Claim claim = ratio_claim({}, 1.0);
    ASSERT_LT(measure_quantity(cells, claim.quantity).summary.upper, 1.0) << "the mean alone would say that it holds";
    EXPECT_EQ(judge_claim(claim, cells).verdict, ClaimVerdict::depends);
}

TEST(Claims, OneViewAndNoViewProveNothing) {
    const auto one = judge_claim(ratio_claim({}, 1.0), cells_with_ratios("room", {0.5}));
    EXPECT_EQ(one.verdict, ClaimVerdict::untested);
    EXPECT_THAT(one.reason, HasSubstr("only one case"));
    EXPECT_EQ(judge_claim(ratio_claim({}, 1.0), std::vector<Cell>{}).verdict, ClaimVerdict::untested);
}

TEST(Claims, CellsWithoutTheMeasureAreCountedAsMissing) {
    std::vector<Cell> cells = cells_with_ratios("room", {0.5, 0.5});
    cells.push_back({"room", "view c", "ao", "", "two", ""});  // refused: no error
    cells.push_back(cell_with("room", "view d", "two", 0.1));  // nothing to set it against
    cells.push_back(cell_with("room", "view c", "one", 0.1));
    const Measured measured = measure_quantity(cells, ratio_claim({}, 1.0).quantity);
    EXPECT_EQ(measured.cases.size(), 2u);
    EXPECT_EQ(measured.missing, 2);
}

TEST(Claims, SelectorsThatFitTwoCellsAreRefused) {
    std::vector<Cell> cells = cells_with_ratios("room", {0.5});
    Claim claim = ratio_claim({}, 1.0);
    claim.quantity.second = {};
    cells.push_back(cell_with("room", "view a", "three", 0.2));
    EXPECT_THAT(message_of<ConfigError>([&] { judge_claim(claim, cells); }),
                HasSubstr("both 'one' and 'three' could be what 'two' is set against"));
}

TEST(Claims, PairsMayDifferInThePlaneThatTheSelectorsName) {
    std::vector<Cell> cells = {cell_with("room", "view a", "one", 0.1), cell_with("room", "view a", "one", 0.4)};
    cells[1].plane = "indirect", cells[1].truth = "full";
    MeasuredQuantity quantity{"rmse", QuantityKind::difference, {}, {}, {}};
    quantity.first.wanted["plane"] = {"ao"};
    quantity.second.wanted = {{"plane", {"indirect"}}, {"truth", {"full"}}};
    const Measured measured = measure_quantity(cells, quantity);
    ASSERT_EQ(measured.cases.size(), 1u);
    EXPECT_NEAR(measured.cases[0].value, -0.3, 1e-12);
}

TEST(Claims, SlopesAreThoseOfLogarithms) {
    std::vector<Cell> cells;
    for (const double samples : {4.0, 16.0, 64.0}) {
        Cell cell{"room", "front", "ao", "", "taps", "taps", samples};
        cell.set("rmse", 3.0 / std::sqrt(samples));
        cells.push_back(cell);
        cell.place = "left";
        cells.push_back(cell);
    }
    MeasuredQuantity quantity{"rmse", QuantityKind::slope, {}, {}, {}};
    quantity.first.wanted["curve"] = {"taps"};
    const Measured measured = measure_quantity(cells, quantity);
    ASSERT_EQ(measured.cases.size(), 2u);
    EXPECT_NEAR(measured.summary.mean, -0.5, 1e-12);
    // Two points are always on a line.
    cells.resize(4);
    EXPECT_EQ(measure_quantity(cells, quantity).missing, 2);
}

TEST(Measures, AreSumsOfPassesAndCombinations) {
    Cell cell{"room", "front", "ao", "", "one", ""};
    cell.set("ms of gbuffer", 2.0);
    cell.set("ms of gbuffer.layer2", 3.0);
    cell.set("ms of shadows", 7.0);
    cell.set("infinite", std::numeric_limits<double>::infinity());
    EXPECT_DOUBLE_EQ(measure_of(cell, "ms of gbuffer*"), 5.0);
    EXPECT_DOUBLE_EQ(measure_of(cell, "ms of gbuffer"), 2.0);
    // From left to right: (2 + 3) * 7.
    EXPECT_DOUBLE_EQ(measure_of(cell, "ms of gbuffer + ms of gbuffer.layer2 * ms of shadows"), 35.0);
    EXPECT_DOUBLE_EQ(measure_of(cell, "ms of gbuffer.layer2 / ms of gbuffer"), 1.5);
    EXPECT_TRUE(std::isnan(measure_of(cell, "rmse / ms of gbuffer")));
    EXPECT_TRUE(std::isnan(measure_of(cell, "infinite"))) << "what is not finite is no measurement";
}

TEST(ClaimsReport, FilesReadBackAndFillTheTable) {
    ClaimResult result = judge_claim(ratio_claim({}, 1.0), cells_with_ratios("room", {0.7, 1.2, 0.9}));
    result.experiment = "trial";
    result.claim.claim = "a | b";
    const TemporaryFolder folder;
    write_text_atomically(folder.path / "claims.json", print_claims_json({result}, false));
    const std::vector<ClaimRecord> records = read_claims_json(folder.path / "claims.json");
    ASSERT_EQ(records.size(), 1u);
    EXPECT_EQ(records[0].measured, record_of(result, false).measured);
    EXPECT_EQ(records[0].scenes, record_of(result, false).scenes);
    EXPECT_EQ(records[0].cases, 3);
    const std::string table = print_claims_markdown(records, "plumbline reproduce --all");
    EXPECT_THAT(table, HasSubstr("1 claims: 0 hold, 0 fail, 1 depend on what is seen, 0 were not decided"));
    EXPECT_THAT(table, HasSubstr("| 1 | a \\| b | 000, section 1 |"));
    EXPECT_THAT(table, HasSubstr("**depends**: on the view: holds in 2 of 3"));
    EXPECT_THAT(table, HasSubstr("has to be below 1; 3 cases"));
}

TEST(ClaimsReport, OtherFilesAreRefusedByName) {
    const TemporaryFolder folder;
    write_text_atomically(folder.path / "claims.json", "{\"claims\": 3}");
    EXPECT_THAT(message_of<ConfigError>([&] { read_claims_json(folder.path / "claims.json"); }),
                testing::AllOf(HasSubstr("claims.json' is not a claims file"), HasSubstr("plumbline reproduce")));
}

}  // namespace
}  // namespace plumb

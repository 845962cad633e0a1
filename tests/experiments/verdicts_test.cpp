// What thresholds make of rows, on results made by hand.
#include "experiments/verdicts.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/check_run.h"
#include "tests/experiments/sample_results.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Threshold limit_of(ThresholdKind kind, const std::string& method, double limit) {
    Threshold threshold;
    threshold.name = "t";
    threshold.kind = kind;
    threshold.rows.plane = "ao", threshold.rows.method = method;
    threshold.measure = "rmse";
    threshold.limit = limit;
    threshold.reason = "r";
    return threshold;
}

Verdict verdict_of(const Threshold& threshold, const std::vector<ResultRow>& rows,
                   const std::vector<CostRatio>& costs = {}) {
    return judge(threshold, value_of(threshold, rows, costs));
}

// Three views of `one` and `two`; the errors of `two` differ.
std::vector<ResultRow> rows_of_three_views() {
    std::vector<ResultRow> rows;
    for (const auto& [view, error] : {std::pair{"front", 0.05}, {"left", 0.1}, {"right", 0.2}}) {
        rows.push_back(sample_row(view, "one", 0.10, 2.0));
        rows.push_back(sample_row(view, "two", error, 4.0));
    }
    return rows;
}

ResultRow path_row(const std::string& method, double flicker) {
    ResultRow row = sample_row("", method, 0.1, 0.0);
    row.path = "strafe";
    row.stability = sample_stability(flicker);
    return row;
}

TEST(Verdicts, AnErrorIsTheWorstOfItsRows) {
    const Verdict verdict = verdict_of(limit_of(ThresholdKind::error, "two", 0.15), rows_of_three_views());
    EXPECT_EQ(verdict.status, VerdictStatus::breached);
    EXPECT_NEAR(*verdict.value.value, 0.2, 1e-12) << "the square root of a square";
    EXPECT_EQ(verdict.value.place, "cornell / right");
    EXPECT_EQ(verdict.value.rows, 3);
    EXPECT_NEAR(verdict.margin(), -1.0 / 3.0, 1e-12);
    EXPECT_THAT(verdict.message,
                AllOf(HasSubstr("0.2"), HasSubstr("cornell / right"), HasSubstr("above"), HasSubstr("0.15")));
}

TEST(Verdicts, AValueAtItsLimitIsKept) {
    std::vector<ResultRow> rows = {sample_row("front", "two", 0.5, 1.0)};  // whose square is exact
    EXPECT_EQ(verdict_of(limit_of(ThresholdKind::error, "two", 0.5), rows).status, VerdictStatus::kept);
    Threshold below = limit_of(ThresholdKind::error, "two", 0.5);
    below.fails_above = false;
    EXPECT_EQ(verdict_of(below, rows).status, VerdictStatus::kept);
}

TEST(Verdicts, MeansAreArithmeticOfErrorsAndGeometricOfRatios) {
    Threshold mean = limit_of(ThresholdKind::error, "two", 1.0);
    mean.over = OverRows::mean;
    EXPECT_NEAR(*verdict_of(mean, rows_of_three_views()).value.value, 0.35 / 3.0, 1e-12);
    Threshold benefit = limit_of(ThresholdKind::benefit, "two", 1.0);
    benefit.relative_to = "one", benefit.over = OverRows::mean;
    EXPECT_NEAR(*verdict_of(benefit, rows_of_three_views()).value.value, 1.0, 1e-12)
        << "a half, one and two multiply to one; their arithmetic mean is 1.17";
    benefit.over = OverRows::worst;
    EXPECT_NEAR(*verdict_of(benefit, rows_of_three_views()).value.value, 2.0, 1e-12);
}

TEST(Verdicts, LimitsFromBelowTakeTheLeastRow) {
    Threshold psnr = limit_of(ThresholdKind::error, "two", 20.0);
    psnr.measure = "ssim", psnr.fails_above = false, psnr.limit = 0.5;
    std::vector<ResultRow> rows = rows_of_three_views();
    for (std::pair<std::string, double>& measure : rows[3].measures) {
        if (measure.first == "ssim") measure.second = -0.25;
    }
    for (const std::size_t i : {1, 5}) {
        for (std::pair<std::string, double>& measure : rows[i].measures) {
            if (measure.first == "ssim") measure.second = 0.75;
        }
    }
    const Verdict verdict = verdict_of(psnr, rows);
    EXPECT_EQ(verdict.status, VerdictStatus::breached);
    EXPECT_EQ(verdict.value.place, "cornell / left");
    EXPECT_NEAR(verdict.margin(), -1.5, 1e-12);
}

TEST(Verdicts, ARowWhoseTruthIsTooNoisyIsNoPass) {
    std::vector<ResultRow> rows = rows_of_three_views();
    rows[1].measured = false, rows[1].refusal = "not measured: 4096 samples would do";
    const Verdict kept_but = verdict_of(limit_of(ThresholdKind::error, "two", 1.0), rows);
    EXPECT_EQ(kept_but.status, VerdictStatus::untold);
    EXPECT_THAT(kept_but.message, AllOf(HasSubstr("cornell / front"), HasSubstr("4096 samples")));
    EXPECT_EQ(verdict_of(limit_of(ThresholdKind::error, "two", 0.15), rows).status, VerdictStatus::breached)
        << "another row breaks the limit, whatever this one would say";
    Threshold benefit = limit_of(ThresholdKind::benefit, "one", 10.0);
    benefit.relative_to = "two";
    EXPECT_EQ(verdict_of(benefit, rows).status, VerdictStatus::untold) << "a ratio needs both";
}

TEST(Verdicts, AThresholdThatMatchesNoRowIsNoPass) {
    Threshold elsewhere = limit_of(ThresholdKind::error, "two", 1.0);
    elsewhere.rows.view = "back";
    const Verdict verdict = verdict_of(elsewhere, rows_of_three_views());
    EXPECT_EQ(verdict.status, VerdictStatus::unmatched);
    EXPECT_THAT(verdict.message, AllOf(HasSubstr("view 'back'"), HasSubstr("view front, view left, view right")));
    EXPECT_EQ(verdict_of(limit_of(ThresholdKind::cost, "two", 1.0), rows_of_three_views()).status,
              VerdictStatus::unmatched)
        << "no cost was measured against the workload";
}

TEST(Verdicts, RowsOfPathsAndViewsAreToldApart) {
    std::vector<ResultRow> rows = rows_of_three_views();
    rows.push_back(path_row("two", 0.03));
    Threshold flicker = limit_of(ThresholdKind::flicker, "two", 0.02);
    flicker.measure = "flicker", flicker.rows.view = "", flicker.rows.path = "*";
    const Verdict verdict = verdict_of(flicker, rows);
    EXPECT_EQ(verdict.status, VerdictStatus::breached);
    EXPECT_EQ(verdict.value.rows, 1);
    EXPECT_EQ(verdict.value.place, "cornell / strafe");
    EXPECT_EQ(verdict_of(limit_of(ThresholdKind::error, "two", 1.0), rows).value.rows, 3);
    flicker.region = "silhouettes";
    rows.back().regions.push_back({"silhouettes", 100, 0.01, 0.009, 0.011, sample_stability(0.05)});
    rows.back().regions.push_back({"border", 100, 0.01, 0.009, 0.011});
    EXPECT_EQ(*verdict_of(flicker, rows).value.value, 0.05);
    flicker.region = "border";
    EXPECT_EQ(verdict_of(flicker, rows).status, VerdictStatus::untold);
    flicker.region = "";
    flicker.kind = ThresholdKind::benefit, flicker.relative_to = "one", flicker.limit = 0.7;
    rows.push_back(path_row("one", 0.06));
    EXPECT_NEAR(*verdict_of(flicker, rows).value.value, 0.5, 1e-12);
}

TEST(Verdicts, FlickerThatTheTruthsNoiseDrownsIsUntoldWithTheSamplesThatWouldDo) {
    std::vector<ResultRow> rows = {path_row("two", 0.03)};
    Threshold flicker = limit_of(ThresholdKind::flicker, "two", 0.1);
    flicker.measure = "flicker", flicker.rows.view = "", flicker.rows.path = "*";
    EXPECT_EQ(verdict_of(flicker, rows).status, VerdictStatus::kept);
    // Noise of the same size: its square has to fall to a tenth, so ten times as many samples as 64.
    rows[0].stability->noise = 0.03, rows[0].stability->trustworthy = false;
    const Verdict verdict = verdict_of(flicker, rows);
    EXPECT_EQ(verdict.status, VerdictStatus::untold);
    EXPECT_THAT(verdict.message, AllOf(HasSubstr("too near to the flicker"), HasSubstr("640 samples per pixel")));
    flicker.measure = "method_warping", flicker.limit = 0.6;
    EXPECT_EQ(*verdict_of(flicker, rows).value.value, 0.5) << "of images alone: no noise of the truth in it";
    flicker.measure = "temporal_variance";
    EXPECT_EQ(*verdict_of(flicker, rows).value.value, 0.01) << "its interval excludes zero";
    rows[0].stability->temporal_variance.lower = -0.01;
    EXPECT_EQ(verdict_of(flicker, rows).status, VerdictStatus::untold);
}

TEST(Verdicts, TruthsAreToldApartAndPlanesWithOneMatchAny) {
    std::vector<ResultRow> rows = {sample_row("front", "two", 0.1, 1.0), sample_row("front", "two", 0.3, 1.0)};
    rows[0].truth = "full", rows[1].truth = "within 0.3 m";
    EXPECT_NEAR(*verdict_of(limit_of(ThresholdKind::error, "two", 1.0), rows).value.value, 0.1, 1e-12);
    Threshold limited = limit_of(ThresholdKind::error, "two", 1.0);
    limited.rows.truth = "within*";
    EXPECT_NEAR(*verdict_of(limited, rows).value.value, 0.3, 1e-12);
    rows[0].truth = "";
    EXPECT_EQ(verdict_of(limited, rows).value.rows, 2);
}

TEST(Verdicts, StarsDoNotCoverThePathTracerAndTheOracle) {
    std::vector<ResultRow> rows = rows_of_three_views();
    rows.push_back(sample_row("front", "path tracer, 4 spp", 0.9, 1.0));
    rows.back().path_tracer_samples = 4;
    rows.push_back(sample_row("front", "oracle", 0.8, 1.0));
    rows.back().oracle.layers = 2;
    EXPECT_NEAR(*verdict_of(limit_of(ThresholdKind::error, "*", 1.0), rows).value.value, 0.2, 1e-12);
    EXPECT_NEAR(*verdict_of(limit_of(ThresholdKind::error, "path tracer, 4 spp", 1.0), rows).value.value, 0.9, 1e-12);
}

TEST(Verdicts, RegionsHaveTheirOwnError) {
    std::vector<ResultRow> rows = {sample_row("front", "two", 0.1, 1.0)};
    rows[0].regions = {
        {"silhouettes", 100, 0.25, 0.2, 0.3}, {"border", 0, 0.0, 0.0, 0.0}, {"rest", 9, 0.01, -0.1, 0.2}};
    rows[0].regions[2].measured = false;
    rows[0].regions[0].measures = {{"flip", 0.07}};
    Threshold threshold = limit_of(ThresholdKind::error, "two", 0.4);
    threshold.region = "silhouettes";
    EXPECT_NEAR(*verdict_of(threshold, rows).value.value, 0.5, 1e-12);
    threshold.region = "border";
    EXPECT_THAT(verdict_of(threshold, rows).message, HasSubstr("no pixels"));
    threshold.region = "rest";
    EXPECT_THAT(verdict_of(threshold, rows).message, HasSubstr("lost in the truth's noise"));
    threshold.region = "silhouettes", threshold.measure = "flip";
    EXPECT_NEAR(*verdict_of(threshold, rows).value.value, 0.07, 1e-12);
    threshold.measure = "ssim";
    EXPECT_THAT(verdict_of(threshold, rows).message, HasSubstr("ssim over region 'silhouettes' does not exist"));
    threshold.measure = "rmse", threshold.region = "silhouette";
    const Verdict misspelt = verdict_of(threshold, rows);
    EXPECT_EQ(misspelt.status, VerdictStatus::untold);
    EXPECT_THAT(misspelt.message, HasSubstr("did you mean 'silhouettes'?"));
}

TEST(Verdicts, CostsAreRatiosToTheWorkloadOrToAnotherMethod) {
    const std::vector<CostRatio> costs = {{"cornell", "front", "ao", "two", 2.0, 20.0, 10.0},
                                          {"cornell", "left", "ao", "two", 8.0, 80.0, 10.0},
                                          {"cornell", "left", "total", "two", 100.0, 80.0, 10.0}};
    Threshold cost = limit_of(ThresholdKind::cost, "two", 3.9);
    cost.over = OverRows::mean;
    const Verdict verdict = verdict_of(cost, rows_of_three_views(), costs);
    EXPECT_NEAR(*verdict.value.value, 4.0, 1e-12) << "geometric mean of 2 and 8";
    EXPECT_EQ(verdict.status, VerdictStatus::breached);
    cost.relative_to = "one";
    EXPECT_NEAR(*verdict_of(cost, rows_of_three_views(), costs).value.value, 2.0, 1e-12);
}

TEST(Verdicts, TellWhatMovedSinceTheCalibration) {
    Threshold threshold = limit_of(ThresholdKind::error, "two", 1.0);
    const std::vector<ResultRow> rows = {sample_row("front", "two", 0.5, 1.0)};
    threshold.calibrated = CalibratedValue{10, 0.4, 0.05, 0.3, 0.5};
    EXPECT_FALSE(verdict_of(threshold, rows).moved()) << "two spreads away";
    EXPECT_NEAR(verdict_of(threshold, rows).change(), 0.25, 1e-12);
    threshold.calibrated->spread = 0.01;
    EXPECT_TRUE(verdict_of(threshold, rows).moved()) << "ten spreads away";
    threshold.calibrated = CalibratedValue{10, 0.5, 0.0, 0.5, 0.5};
    EXPECT_FALSE(verdict_of(threshold, rows).moved()) << "the same to the last bit";
    EXPECT_TRUE(std::isnan(verdict_of(limit_of(ThresholdKind::error, "two", 1.0), rows).change()));
}

TEST(Verdicts, ManyMovesInOneDirectionAreNoNoise) {
    const std::vector<ResultRow> rows = {sample_row("front", "two", 0.5, 1.0)};
    Threshold worse = limit_of(ThresholdKind::error, "two", 1.0), better = worse;
    worse.calibrated = CalibratedValue{10, 0.4, 0.0, 0.4, 0.4};
    better.calibrated = CalibratedValue{10, 0.6, 0.0, 0.6, 0.6};
    std::vector<Verdict> verdicts(5, verdict_of(worse, rows));
    EXPECT_THAT(describe_movement(verdicts),
                AllOf(HasSubstr("5 for the worse, 0 for the better"), HasSubstr("All in one direction")));
    verdicts.push_back(verdict_of(better, rows));
    EXPECT_THAT(describe_movement(verdicts), testing::Not(HasSubstr("All in one direction")));
    EXPECT_EQ(describe_movement({}), "");
}

class ExitCodes : public testing::Test {
protected:
    static Verdict with_status(VerdictStatus status) {
        Verdict verdict;
        verdict.status = status;
        return verdict;
    }
    CheckResults results_;
};

TEST_F(ExitCodes, FollowTheGravestFinding) {
    EXPECT_EQ(results_.exit_code(), exit_fine);
    results_.verdicts = {with_status(VerdictStatus::kept), with_status(VerdictStatus::unmatched)};
    EXPECT_EQ(results_.exit_code(), exit_wrong_use);
    results_.verdicts.push_back(with_status(VerdictStatus::untold));
    EXPECT_EQ(results_.exit_code(), exit_failed);
    results_.verdicts.back() = with_status(VerdictStatus::breached);
    EXPECT_EQ(results_.exit_code(), exit_failed);
    results_.interrupted = true;
    EXPECT_EQ(results_.exit_code(), exit_interrupted);
}

TEST_F(ExitCodes, FailForCellsAndForGatesThatCannot) {
    results_.failed_cells = {"cornell / front / ao / two: no"};
    EXPECT_EQ(results_.exit_code(), exit_failed);
    results_.failed_cells.clear();
    MustFail must_fail;
    must_fail.name = "broken", must_fail.threshold = "t";
    results_.must_fail = {judge_must_fail(must_fail, with_status(VerdictStatus::breached))};
    EXPECT_TRUE(results_.must_fail[0].proven);
    EXPECT_EQ(results_.exit_code(), exit_fine);
    for (const VerdictStatus status : {VerdictStatus::kept, VerdictStatus::untold, VerdictStatus::unmatched}) {
        results_.must_fail = {judge_must_fail(must_fail, with_status(status))};
        EXPECT_FALSE(results_.must_fail[0].proven) << to_string(status);
        EXPECT_THAT(results_.must_fail[0].message, HasSubstr("the gate cannot fail"));
        EXPECT_EQ(results_.exit_code(), exit_failed) << to_string(status);
    }
}

TEST(MustFailExperiment, RendersOnlyWhereItsThresholdLooks) {
    Experiment experiment;
    experiment.planes = {"ao", "total"};
    Method one, two;
    one.name = "one", two.name = "two";
    experiment.methods = {one, two};
    experiment.path_tracer_samples = {4};
    ExperimentScene cornell, clutter;
    cornell.scene = "cornell", cornell.views = {"front", "gap"};
    clutter.scene = "clutter", clutter.views = {"shelf"}, clutter.paths = {{"strafe", 0.0, 4, 30.0}};
    experiment.scenes = {cornell, clutter};

    MustFail must_fail;
    must_fail.name = must_fail.method.name = "broken";
    Threshold threshold = limit_of(ThresholdKind::benefit, "two", 1.0);
    threshold.relative_to = "one", threshold.rows.scene = "cornell", threshold.rows.view = "ga*";

    const Experiment reduced = must_fail_experiment(experiment, must_fail, threshold);
    ASSERT_EQ(reduced.methods.size(), 2u);
    EXPECT_EQ(reduced.methods[0].name, "broken");
    EXPECT_EQ(reduced.methods[1].name, "one");
    ASSERT_EQ(reduced.scenes.size(), 1u);
    EXPECT_THAT(reduced.scenes[0].views, testing::ElementsAre("gap"));
    EXPECT_TRUE(reduced.path_tracer_samples.empty());
    EXPECT_EQ(reduced.planes, experiment.planes) << "the truth is looked up under them";
    EXPECT_EQ(must_fail_threshold(must_fail, threshold).rows.method, "broken");

    threshold.rows = {"*", "", "strafe", "ao", "full", "two"};
    const Experiment on_path = must_fail_experiment(experiment, must_fail, threshold);
    ASSERT_EQ(on_path.scenes.size(), 2u);
    EXPECT_TRUE(on_path.scenes[0].paths.empty());
    EXPECT_EQ(on_path.scenes[0].views.size(), 1u);
    EXPECT_EQ(on_path.scenes[1].paths.size(), 1u);
}

}  // namespace
}  // namespace plumb

// The experiment of kind "convergence": its file, its fits, and what it leaves behind.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/convergence_report.h"
#include "experiments/experiment_file.h"
#include "experiments/svg_chart.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

ConvergenceExperiment parse(const std::string& text) {
    return parse_convergence(parse_config(text, "c.toml"), "c.toml");
}

const std::string valid =
    "kind = \"convergence\"\nresolution = [16, 9]\nsamples = [4, 16, 64]\nseeds = 3\n"
    "planes = [\"ao\", \"indirect\"]\nreference_samples = 1024\n[[scenes]]\nscene = \"cornell\"\n";

TEST(ConvergenceFile, ReadsWhatItSaysAndTellsItsKind) {
    const ConvergenceExperiment experiment = parse(valid);
    EXPECT_THAT(experiment.samples, testing::ElementsAre(4, 16, 64));
    EXPECT_EQ(experiment.seeds, 3);
    ASSERT_EQ(experiment.scenes.size(), 1u);
    EXPECT_EQ(kind_of(parse_config(valid, "c.toml"), "c.toml"), ExperimentKind::convergence);
    EXPECT_EQ(kind_of(parse_config("planes = []", "c.toml"), "c.toml"), ExperimentKind::comparison);
    const auto shipped = PLUMBLINE_SOURCE_DIR "/experiments/convergence.toml";
    EXPECT_EQ(parse_convergence(read_config(shipped), shipped).scenes.size(), 3u);
}

TEST(ConvergenceFile, MistakesAreReportedWithTheirLine) {
    const auto failure = [](const std::string& text) { return message_of<ConfigError>([&] { parse(text); }); };
    EXPECT_THAT(failure("samples = [4, 8]\n[[scenes]]\nscene = \"cornell\""),
                AllOf(HasSubstr("c.toml:1: samples"), HasSubstr("three or more")));
    EXPECT_THAT(failure("samples = [4, 9, 16]\n[[scenes]]\nscene = \"cornell\""), HasSubstr("even"));
    EXPECT_THAT(failure("samples = [4, 16, 8]\n[[scenes]]\nscene = \"cornell\""), HasSubstr("ascend"));
    EXPECT_THAT(failure("planes = [\"depth\"]\n[[scenes]]\nscene = \"cornell\""), HasSubstr("c.toml:1: planes"));
    EXPECT_THAT(failure("seeds = 2"), HasSubstr("'scenes' is missing"));
    EXPECT_THAT(message_of<ConfigError>([] { kind_of(parse_config("kind = \"convergense\"", "c.toml"), "c.toml"); }),
                HasSubstr("did you mean 'convergence'?"));
}

TEST(ConvergenceFit, FindsTheSlopeOfAPowerLawAndLeavesOutWhatTheReferenceCannotTell) {
    ConvergenceCurve curve;
    for (const int seed : {1, 2, 3}) {
        for (const int samples : {4, 8, 16, 32}) {
            // RMSE = seed / samples^(0.7 + 0.01 seed)
            const double rmse = seed * std::pow(samples, -0.7 - 0.01 * seed);
            curve.measurements.push_back({samples, seed, rmse * rmse, 0.1 * rmse * rmse, false});
        }
        curve.measurements.push_back({64, seed, 1e-9, 1e-9, false});    // as much noise as error
        curve.measurements.push_back({128, seed, -1e-9, 1e-9, false});  // lost in noise
    }
    fit(curve, 0.5);
    EXPECT_NEAR(curve.slope.mean, -0.72, 1e-12);
    EXPECT_NEAR(curve.slope.standard_error, 0.01 / std::sqrt(3.0), 1e-12);
    // Student's 97.5 % quantile for two degrees of freedom is 4.303.
    EXPECT_NEAR(curve.slope.lower, -0.72 - 4.303 * 0.01 / std::sqrt(3.0), 1e-12);
    EXPECT_NEAR(curve.rmse_at_one, std::cbrt(6.0), 1e-12);
    EXPECT_EQ(curve.rmse(64), 0.0);
    const double a = std::pow(4, -0.71), b = 2 * std::pow(4, -0.72), c = 3 * std::pow(4, -0.73);
    EXPECT_NEAR(curve.rmse(4), std::sqrt((a * a + b * b + c * c) / 3), 1e-12);
    EXPECT_NEAR(curve.least_rmse(4), a, 1e-12);
    EXPECT_NEAR(curve.greatest_rmse(4), c, 1e-12);
}

TEST(Convergence, MeasuresTheKnownSlopeOfRandomPointsAndASteeperOneOfSobolPoints) {
    const TemporaryFolder folder;
    RunOptions options;
    options.cache_dir = folder.path / "cache";
    const ConvergenceResults results = run_convergence(parse(valid), SceneFinder({}), options);
    ASSERT_EQ(results.curves.size(), 4u);
    for (std::size_t i = 0; i < results.curves.size(); i += 2) {
        const ConvergenceCurve &random = results.curves[i], &sobol = results.curves[i + 1];
        ASSERT_EQ(random.slope.count, 3);
        // 144 pixels with three seeds: log2 of an RMSE over 432 independent errors is good to 0.05, the slope over four
        // doublings to 0.03; four of it.
        EXPECT_NEAR(random.slope.mean, -0.5, 0.12) << random.plane;
        EXPECT_LT(sobol.slope.mean, random.slope.mean) << random.plane;
        EXPECT_LT(sobol.rmse(64), random.rmse(64)) << random.plane;
    }
    write_convergence_files(results, folder.path);
    for (const char* file : {"convergence.csv", "convergence.json", "convergence.svg", "index.html"})
        EXPECT_TRUE(std::filesystem::exists(folder.path / file)) << file;
    EXPECT_THAT(print_convergence_table(results), AllOf(HasSubstr("cornell"), HasSubstr("indirect"), HasSubstr("±")));
    EXPECT_THAT(print_convergence_csv(results), HasSubstr("cornell,front,ao,Sobol,3,64,"));
    const std::string page = print_convergence_page(results);
    EXPECT_THAT(page, AllOf(HasSubstr("<svg"), Not(HasSubstr("src=")), Not(HasSubstr("href="))));
}

TEST(Convergence, ASceneThatFailsDoesNotEndTheOthers) {
    const TemporaryFolder folder;
    RunOptions options;
    options.cache_dir = folder.path / "cache";
    ConvergenceExperiment experiment = parse(valid);
    experiment.samples = {2, 4, 8}, experiment.seeds = 1, experiment.reference_samples = 16;
    experiment.scenes.insert(experiment.scenes.begin(), experiment.scenes.front());
    experiment.scenes[0].scene = "no_such_scene";
    const ConvergenceResults results = run_convergence(experiment, SceneFinder({}), options);
    EXPECT_EQ(results.curves.size(), 4u);
    for (const ConvergenceCurve& curve : results.curves) EXPECT_EQ(curve.scene, "cornell");
    ASSERT_EQ(results.failures.size(), 1u);
    EXPECT_EQ(results.failures[0].cell, "no_such_scene");
    EXPECT_THAT(print_convergence_json(results), HasSubstr("no_such_scene"));
}

TEST(SvgChart, TicksAreRoundNumbersWithinTheRange) {
    EXPECT_THAT(logarithmic_ticks(0.9, 12.0), testing::Pointwise(testing::DoubleEq(), {1.0, 2.0, 5.0, 10.0}));
    EXPECT_THAT(logarithmic_ticks(0.009, 20.0), testing::Pointwise(testing::DoubleEq(), {0.01, 0.1, 1.0, 10.0}));
    EXPECT_THAT(logarithmic_ticks(0.024, 0.029),
                testing::Pointwise(testing::DoubleNear(1e-12), {0.024, 0.025, 0.026, 0.027, 0.028, 0.029}));
}

TEST(SvgChart, DrawsPointsWhereTheyBelongAndEscapesText) {
    Chart chart{"a < b", "x", "y", {}};
    chart.series.push_back({"up & down", "#0072b2", {{1, 1, 0, 0}, {100, 100, 0, 0}, {-1, 3, 0, 0}}});
    const std::string svg = print_svg({chart}, 1, "title");
    EXPECT_THAT(svg, AllOf(HasSubstr("a &lt; b"), HasSubstr("up &amp; down"), HasSubstr("<svg xmlns="),
                           Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
    // Two markers in the panel and one in the legend; the negative point is left out.
    std::size_t circles = 0;
    for (auto at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) ++circles;
    EXPECT_EQ(circles, 3u);
    // On both axes the points lie 4 % of the range from the ends: from 64 to 316 across, from 264 up to 70.
    EXPECT_THAT(svg, HasSubstr("<path d=\"M73.3 256.8 L306.7 77.2\""));
}

TEST(SvgChart, AChartWithoutPointsIsStillAChart) {
    EXPECT_THAT(print_svg({{"empty", "x", "y", {}}}, 1, "title"), AllOf(HasSubstr("empty"), Not(HasSubstr("nan"))));
}

}  // namespace
}  // namespace plumb

// Error over cost: the front, readings of the path tracer's curve, rows and the figure, on numbers that can be checked
// by hand; and what the chart draws them with.
#include "experiments/accuracy_figure.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/pareto.h"
#include "experiments/svg_chart.h"
#include "experiments/svg_raster.h"
#include "tests/experiments/sample_results.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(ParetoFront, HoldsWhoeverNobodyBeatsInBoth) {
    // By rising time; the third is slower and worse than the first, the fifth equal to the fourth.
    EXPECT_THAT(pareto_front({{1, 0.5}, {4, 0.1}, {2, 0.6}, {3, 0.2}, {3, 0.2}}), ElementsAre(0, 3, 1));
    EXPECT_THAT(pareto_front({{2, 0.5}, {1, 0.5}}), ElementsAre(1));
    EXPECT_THAT(pareto_front({}), ElementsAre());
}

TEST(CostCurve, ReadsPowerLawsExactly) {
    // error = 1 / sqrt(ms): what independent samples do.
    const CostCurve curve({{100, 0.1}, {4, 0.5}, {25, 0.2}});
    EXPECT_NEAR(curve.error_at(16)->value, 0.25, 1e-12);
    EXPECT_FALSE(curve.error_at(16)->extrapolated);
    EXPECT_NEAR(curve.error_at(400)->value, 0.05, 1e-12);
    EXPECT_TRUE(curve.error_at(400)->extrapolated);
    EXPECT_NEAR(curve.milliseconds_at(0.25)->value, 16, 1e-9);
    EXPECT_FALSE(curve.milliseconds_at(0.25)->extrapolated);
    EXPECT_NEAR(curve.milliseconds_at(1.0)->value, 1, 1e-9);
    EXPECT_TRUE(curve.milliseconds_at(1.0)->extrapolated);
}

TEST(CostCurve, SaysNothingWhereItCannotKnow) {
    EXPECT_FALSE(CostCurve({{4, 0.5}}).error_at(4));
    EXPECT_FALSE(CostCurve({{4, 0.5}, {4, 0.4}}).error_at(4));
    // A curve that does not fall any more reaches no smaller error.
    EXPECT_FALSE(CostCurve({{4, 0.5}, {8, 0.5}}).milliseconds_at(0.1));
}

// The sample's methods have RMSE 0.1 in 2 ms and 0.05 in 4 ms; the path tracer gets 0.2 in 1 ms and 0.05 in 16 ms.
RunResults results_with_path_tracer() {
    RunResults results = sample_results();
    for (const std::string view : {"front", "left", "right"}) {
        for (const auto& [samples, rmse, milliseconds] : {std::tuple{2, 0.2, 1.0}, std::tuple{32, 0.05, 16.0}}) {
            ResultRow row =
                sample_row(view, samples == 2 ? "path tracer, 2 spp" : "path tracer, 32 spp", rmse, milliseconds);
            row.path_tracer_samples = samples;
            results.rows.push_back(row);
        }
    }
    return results;
}

TEST(EqualRows, CompareWithThePathTracerAtEqualTimeAndEqualError) {
    const std::vector<EqualRow> rows = equal_rows(results_with_path_tracer());
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].method, "one");
    EXPECT_EQ(rows[0].views, 3);
    EXPECT_TRUE(rows[0].on_front);
    EXPECT_TRUE(rows[1].on_front);
    // Its error is 0.2 / sqrt(ms).
    EXPECT_NEAR(rows[0].rmse_ratio, 0.2 / std::sqrt(2.0) / 0.1, 1e-9);
    EXPECT_NEAR(rows[0].time_ratio, 4.0 / 2.0, 1e-9);
    EXPECT_NEAR(rows[1].rmse_ratio, 0.1 / 0.05, 1e-9);
    EXPECT_NEAR(rows[1].time_ratio, 16.0 / 4.0, 1e-9);
    EXPECT_EQ(rows[1].extrapolated_at_equal_error, 0);
}

TEST(EqualRows, TwoViewsAreTooFewForAnInterval) {
    RunResults results = results_with_path_tracer();
    EXPECT_FALSE(std::isnan(equal_rows(results)[0].rmse_ratio_lower));
    std::erase_if(results.rows, [](const ResultRow& row) { return row.view == "right"; });
    const std::vector<EqualRow> rows = equal_rows(results);
    EXPECT_EQ(rows[0].views, 2);
    EXPECT_GT(rows[0].rmse_ratio, 0.0);
    EXPECT_TRUE(std::isnan(rows[0].rmse_ratio_lower) && std::isnan(rows[0].time_ratio_upper));
    EXPECT_THAT(print_equal_rows_csv(results), HasSubstr(",1.41421,,,0,2,,,0\n"));
}

TEST(EqualRows, WithoutAPathTracerThereIsNothingToCompareWith) {
    const std::vector<EqualRow> rows = equal_rows(sample_results());
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].rmse_ratio, 0.0);
    EXPECT_THAT(print_equal_rows(sample_results()), HasSubstr("-"));
    EXPECT_EQ(print_equal_rows(RunResults{}), "");
}

TEST(AccuracyFigure, DrawsMethodsFrontAndPathTracer) {
    const std::string svg = print_accuracy_figure(results_with_path_tracer());
    EXPECT_THAT(svg, AllOf(HasSubstr("cornell: ao"), HasSubstr("path tracer"), HasSubstr("front"), HasSubstr(">32<"),
                           testing::Not(HasSubstr("nan"))));
    EXPECT_THAT(rasterise_svg(svg, 1.0), testing::StartsWith("\x89PNG"));
    EXPECT_EQ(print_accuracy_figure(RunResults{}), "");
}

TEST(SvgChart, LinearTicksAreRoundAndFew) {
    EXPECT_THAT(linear_ticks(0.0, 1.0), testing::Pointwise(testing::DoubleNear(1e-12), {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}));
    EXPECT_THAT(linear_ticks(-0.3, 0.31), testing::Pointwise(testing::DoubleNear(1e-12), {-0.2, 0.0, 0.2}));
    EXPECT_THAT(linear_ticks(0.0, 30.0),
                testing::Pointwise(testing::DoubleNear(1e-12), {0., 5., 10., 15., 20., 25., 30.}));
}

TEST(SvgChart, NumbersOfAnAxisDoNotRunIntoEachOther) {
    Chart chart{"curve", "", "", {}};
    chart.series.push_back({"a", "#0072b2", {{0.0005, 1}, {0.1, 2}}, ChartSeries::Style::markers_and_line});
    const std::string svg = print_svg({chart}, 1, "separations");
    // Two decades and a third on some 250 pixels: 0.0005 and 0.001 are 33 apart, as long as the two numbers are.
    EXPECT_THAT(svg, AllOf(HasSubstr(">0.0005<"), testing::Not(HasSubstr(">0.001<")), HasSubstr(">0.002<"),
                           HasSubstr(">0.1<")));
}

TEST(SvgChart, BarsStandOnTheirBaseAndWaterfallsFloat) {
    Chart chart{"bars", "", "ms", {}};
    chart.y_scale = ChartScale::linear;
    chart.categories = {"a", "b"};
    chart.series.push_back({"steps", "#0072b2", {{0, 2, 0, 0, 0}, {1, 3, 0, 0, 2}}, ChartSeries::Style::bars});
    chart.is_waterfall = true;
    const std::string svg = print_svg({chart}, 1, "waterfall");
    // The axis goes from 0, where bars begin, to 3 and 5 % more: pixels 224 up to 30 of the panel, which begins 40
    // below. The first bar is 2 / 3.15 of that high, the second 1 / 3.15 and stands where the first ends.
    EXPECT_THAT(svg, AllOf(HasSubstr("y=\"140.8\" width=\"92.7\" height=\"123.2\""),
                           HasSubstr("y=\"79.2\" width=\"92.7\" height=\"61.6\"")));
    EXPECT_THAT(rasterise_svg(svg, 1.0), testing::StartsWith("\x89PNG"));
}

// Where `attribute` of the first element begins whose content is `content`.
double attribute_of(const std::string& svg, const std::string& content, const std::string& attribute) {
    const std::size_t element = svg.rfind('<', svg.find(">" + content + "<"));
    const std::string name = " " + attribute + "=\"";
    return std::stod(svg.substr(svg.find(name, element) + name.size()));
}

TEST(SvgChart, NamesAslantStayWithinTheFigureAndLabelsOfBarsBesideThem) {
    const std::string long_name = "a name of thirty letters, at least";
    Chart chart{"bars", "", "ms", {}};
    chart.y_scale = ChartScale::linear;
    chart.categories = {long_name, "b", "c"};
    chart.is_waterfall = true;
    chart.series.push_back(
        {"steps", "#0072b2", {{0, 2}, {1, 3, 2.8, 3.2, 2}, {2, 3.1, 0, 0, 3}}, ChartSeries::Style::bars});
    chart.series[0].labels = {"saves much", "saves", ""};
    const std::string svg = print_svg({chart}, 1, "waterfall");
    // Turned about its end: by the cosine of 25 degrees times its length, at some 6 pixels a letter, to the left.
    EXPECT_GT(attribute_of(svg, long_name, "x"), 0.9 * 6.0 * static_cast<double>(long_name.size()));
    // The first bar stands on the axis: its label is above its end. The second floats: its label hangs below its
    // whisker.
    EXPECT_THAT(svg, AllOf(testing::ContainsRegex("text-anchor=\"start\"[^>]*rotate.-90[^>]*>saves much<"),
                           testing::ContainsRegex("text-anchor=\"end\"[^>]*rotate.-90[^>]*>saves<")));
    EXPECT_LT(attribute_of(svg, "saves much", "y"), attribute_of(svg, "saves", "y"));
}

}  // namespace
}  // namespace plumb

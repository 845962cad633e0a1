#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>

#include "frames/image_error.h"
#include "metrics/fidelity_series.h"
#include "metrics/gbuffer_fidelity.h"

namespace plumb {
namespace {

constexpr int width = 10, height = 4;
constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr double float32 = 1e-6;  // relative, of values stored in single precision

Frame gbuffer() {
    Frame frame(width, height);
    frame.set("depth", Image(width, height, 1, 4.0f));
    frame.set("albedo", Image(width, height, 3, 0.5f));
    frame.set("motion", Image(width, height, 2));
    Image& normal = frame.set("normal", Image(width, height, 3));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) normal.at(x, y, 1) = 1.0f;
    }
    return frame;
}

TEST(GbufferFidelity, OfEqualBuffersIsPerfect) {
    const auto layers = gbuffer_fidelity(gbuffer(), gbuffer());
    ASSERT_EQ(layers.size(), 1u);
    EXPECT_EQ(layers[0].layer, "layer1");
    EXPECT_EQ(layers[0].agreement.value, 1.0);
    EXPECT_EQ(layers[0].hit_agreement.lower, 1.0);
    EXPECT_EQ(layers[0].depth->maximum, 0.0);
    EXPECT_EQ(layers[0].normal->maximum, 0.0);
}

TEST(GbufferFidelity, CountsHitsThatOnlyOneSideHas) {
    Frame test = gbuffer(), reference = gbuffer();
    test.plane("depth").at(0, 0) = infinite;  // missed
    test.plane("depth").at(1, 0) = 0.0f;      // missed, as others write it
    reference.plane("depth").at(2, 0) = infinite;
    test.plane("depth").at(3, 0) = reference.plane("depth").at(3, 0) = infinite;
    const LayerFidelity layer = gbuffer_fidelity(test, reference)[0];
    EXPECT_EQ(layer.pixels, 40u);
    EXPECT_EQ(layer.both_hit, 36u);
    EXPECT_EQ(layer.only_test, 1u);
    EXPECT_EQ(layer.only_reference, 2u);
    EXPECT_DOUBLE_EQ(layer.hit_agreement.value, 37.0 / 40.0);
    EXPECT_DOUBLE_EQ(layer.agreement.value, 37.0 / 40.0);
    EXPECT_EQ(layer.depth->values, 36u);
    EXPECT_LT(layer.hit_agreement.lower, layer.hit_agreement.value);
    EXPECT_GT(layer.hit_agreement.upper, layer.hit_agreement.value);
}

TEST(GbufferFidelity, MatchesErrorsComputedByHand) {
    Frame test = gbuffer();
    // Four of forty pixels, one in each plane: 4.04 m for 4 m is 1 %; a normal turned by 3 degrees; a red channel off
    // by 0.25; motion (3, 4) instead of none.
    test.plane("depth").at(0, 0) = 4.04f;
    const double angle = 3.0 * std::numbers::pi / 180.0;
    test.plane("normal").at(1, 1, 0) = static_cast<float>(std::sin(angle));
    test.plane("normal").at(1, 1, 1) = static_cast<float>(std::cos(angle));
    test.plane("albedo").at(2, 2, 0) = 0.75f;
    test.plane("motion").at(3, 3, 0) = 3.0f;
    test.plane("motion").at(3, 3, 1) = 4.0f;
    const LayerFidelity layer = gbuffer_fidelity(test, gbuffer())[0];
    EXPECT_NEAR(layer.depth->maximum, 0.01, float32);
    EXPECT_NEAR(layer.depth->mean.value, 0.01 / 40, float32);
    EXPECT_NEAR(layer.normal->maximum, 3.0, 3 * float32 * 180 / std::numbers::pi);
    EXPECT_NEAR(layer.albedo->maximum, 0.25, float32);
    EXPECT_NEAR(layer.motion->maximum, 5.0, 5 * float32);
    EXPECT_EQ(layer.depth->median.value, 0.0);
    // Of 40 ordered values the 99th percentile lies at 38.61: 0.61 of the way from 0 to the largest.
    EXPECT_NEAR(layer.depth->percentile_99.value, 0.61 * 0.01, float32);
    EXPECT_EQ(layer.depth->percentile_95.value, 0.0);
    EXPECT_DOUBLE_EQ(layer.agreement.value, 37.0 / 40.0) << "motion does not count towards it";
    EXPECT_EQ(layer.hit_agreement.value, 1.0);

    GbufferFidelitySettings lenient;
    lenient.normal_tolerance = 3.1;
    EXPECT_DOUBLE_EQ(gbuffer_fidelity(test, gbuffer(), lenient)[0].agreement.value, 38.0 / 40.0);
    Image mask(width, height, 1);
    mask.at(0, 0) = mask.at(5, 0) = 1.0f;
    lenient.mask = &mask;
    const LayerFidelity masked = gbuffer_fidelity(test, gbuffer(), lenient)[0];
    EXPECT_EQ(masked.pixels, 2u);
    EXPECT_DOUBLE_EQ(masked.agreement.value, 0.5);
    EXPECT_NEAR(masked.depth->mean.value, 0.005, float32);
}

TEST(GbufferFidelity, LooksAtEveryLayerThatBothHaveAndCountsValuesThatAreNotFinite) {
    Frame test = gbuffer(), reference = gbuffer();
    for (Frame* frame : {&test, &reference}) {
        frame->set("layer2.depth", Image(width, height, 1, 5.0f));
        frame->set("layer2.normal", frame->plane("normal"));
    }
    reference.set("layer3.depth", Image(width, height, 1, 6.0f));
    test.plane("layer2.normal").at(4, 0, 2) = std::numeric_limits<float>::quiet_NaN();
    const auto layers = gbuffer_fidelity(test, reference);
    ASSERT_EQ(layers.size(), 2u);
    EXPECT_EQ(layers[1].layer, "layer2");
    EXPECT_EQ(layers[1].normal->left_out, 1u);
    EXPECT_EQ(layers[1].normal->values, 39u);
    EXPECT_DOUBLE_EQ(layers[1].agreement.value, 39.0 / 40.0);
    EXPECT_FALSE(layers[1].albedo) << "nobody has it";
}

TEST(GbufferFidelity, MeasuresHaveFixedNames) {
    const auto list = gbuffer_fidelity(gbuffer(), gbuffer())[0].measures();
    std::map<std::string, double> measures(list.begin(), list.end());
    EXPECT_EQ(measures.at("agreement"), 1.0);
    EXPECT_EQ(measures.at("normal_angle_p95"), 0.0);
    EXPECT_EQ(measures.at("motion_error_mean_upper"), 0.0);
    EXPECT_EQ(list.size(), fidelity_names().size());
    EXPECT_EQ(fidelity_names().front(), "hit_agreement");
    const Frame none(width, height);
    EXPECT_THROW(gbuffer_fidelity(none, none), ImageError);
    Frame wrong = gbuffer();
    wrong.set("normal", Image(width, height, 2));
    EXPECT_THROW(gbuffer_fidelity(wrong, wrong), ImageError);
}

// Depths of 1 m beside depths that are off by these shares of them, row after row.
LayerFidelity with_errors(int columns, int rows, const std::vector<float>& errors,
                          const GbufferFidelitySettings& settings = {}) {
    Frame test(columns, rows), reference(columns, rows);
    Image depth(columns, rows, 1);
    for (std::size_t i = 0; i < errors.size(); ++i) depth.values()[i] = 1.0f + errors[i];
    test.set("depth", depth), reference.set("depth", Image(columns, rows, 1, 1.0f));
    return gbuffer_fidelity(test, reference, settings).front();
}

void expect_interval(const Estimate& of, double value, double lower, double upper, double within) {
    EXPECT_NEAR(of.value, value, within);
    EXPECT_NEAR(of.lower, lower, within);
    EXPECT_NEAR(of.upper, upper, within);
}

TEST(GbufferFidelity, IntervalsOfTwoBlocksAreDrawnByHand) {
    // Both draw the same block twice with probability a quarter: the tails are the errors of either block.
    const ErrorDistribution depth = *with_errors(2, 1, {0.0f, 0.5f}).depth;
    expect_interval(depth.mean, 0.25, 0.0, 0.5, float32);
    expect_interval(depth.percentile_99, 0.495, 0.0, 0.5, 0.001);
    // Half of the errors are up to the median, all or none of either draw.
    expect_interval(depth.median, 0.25, 0.0, 0.5, 0.001);
    GbufferFidelitySettings without;
    without.intervals = false;
    const ErrorDistribution plain = *with_errors(2, 1, {0.0f, 0.5f}, without).depth;
    EXPECT_NEAR(plain.percentile_95.value, 0.475, float32);
    EXPECT_TRUE(std::isnan(plain.percentile_95.lower) && std::isnan(plain.mean.upper));
}

// The hundred errors and SciPy's percentiles of them that test_measure_blocks.cpp has, with the commands.
TEST(GbufferFidelity, IntervalsOfPercentilesMatchSciPy) {
    std::vector<float> errors;
    errors.reserve(100);
    for (int i = 0; i < 100; ++i) errors.push_back(static_cast<float>(std::pow((i * 37 % 101) / 100.0, 3)));
    GbufferFidelitySettings settings;
    settings.bootstrap.resamples = 20000;
    const ErrorDistribution depth = *with_errors(10, 10, errors, settings).depth;
    // Neighbours in their order are 0.008 apart at the median's ends and 0.03 apart at the 95th percentile's; a draw
    // may end at either.
    EXPECT_NEAR(depth.median.lower, 0.0640, 0.008);
    EXPECT_NEAR(depth.median.upper, 0.2056, 0.011);
    EXPECT_NEAR(depth.percentile_95.lower, 0.7074, 0.03);
    EXPECT_NEAR(depth.percentile_95.upper, 0.9426, 0.03);
}

GbufferFidelitySettings of_a_series() {
    GbufferFidelitySettings settings;
    settings.intervals = false, settings.keep_blocks = true;
    return settings;
}

TEST(FidelitySeries, PoolsFramesAndTakesTheLargestOfMaxima) {
    FidelitySeries series;
    series.add(with_errors(2, 1, {0.0f, 0.25f}, of_a_series()));
    series.add(with_errors(2, 1, {infinite, 0.75f}, of_a_series()));  // one side of it holds no surface
    const LayerFidelity all = series.result();
    EXPECT_EQ(series.frames(), 2u);
    EXPECT_EQ(all.layer, "layer1");
    EXPECT_EQ(all.pixels, 4u);
    EXPECT_EQ(all.both_hit, 3u);
    EXPECT_EQ(all.only_reference, 1u);
    EXPECT_EQ(all.depth->values, 3u);
    EXPECT_NEAR(all.hit_agreement.value, 0.75, float32);
    EXPECT_NEAR(all.agreement.value, 0.25, float32);
    EXPECT_NEAR(all.depth->mean.value, 1.0 / 3.0, float32) << "over the values of all frames";
    EXPECT_NEAR(all.depth->median.value, (0.125 + 0.75) / 2, float32) << "the mean of the frames' medians";
    EXPECT_NEAR(all.depth->maximum, 0.75, float32);
    EXPECT_FALSE(all.normal) << "nobody has it";
}

TEST(FidelitySeries, IntervalsCoverWhatChangesFromFrameToFrame) {
    // Each of four frames errs by the same everywhere: intervals are those of four runs of a frame, drawn with
    // replacement. Their mean is 0.25 with a standard deviation of sqrt(0.0125 / 4) = 0.056, a multiple of 0.025.
    FidelitySeries series;
    for (const float error : {0.1f, 0.2f, 0.3f, 0.4f})
        series.add(with_errors(8, 8, std::vector<float>(64, error), of_a_series()));
    const ErrorDistribution depth = *series.result().depth;
    for (const Estimate& of : {depth.mean, depth.median, depth.percentile_95, depth.percentile_99})
        expect_interval(of, 0.25, 0.25 - 1.96 * 0.056, 0.25 + 1.96 * 0.056, 0.03);
    expect_interval(series.result().hit_agreement, 1.0, 1.0, 1.0, float32);
}

// Python 3.11 draws values themselves, frames and pixels at once, and takes the percentiles of each draw's frames:
//
//   frames = [[((f * 64 + p) * 37 % 101 / 100.0)**2 * (0.5 + 0.125 * f) for p in range(64)] for f in range(9)]
//   def percentile(v, q):
//       v = sorted(v); x = q * (len(v) - 1); i = int(x)
//       return v[i] + (v[min(i + 1, len(v) - 1)] - v[i]) * (x - i)
//   def stats(fs, ps):
//       rows = [[frames[f][p] for p in ps] for f in fs]
//       return [sum(map(sum, rows)) / (len(fs) * len(ps))] + [
//           sum(percentile(r, q) for r in rows) / len(rows) for q in (0.5, 0.95)]
//   random.seed(1)
//   draws = [stats([random.randrange(9) for _ in range(9)], [random.randrange(64) for _ in range(64)])
//            for _ in range(8000)]
//   for i in range(3): d = sorted(x[i] for x in draws); print(stats(range(9), range(64))[i], d[199], d[7799])
//
//   0.3361 0.2627 0.4172, 0.2524 0.1890 0.3381, 0.8980 0.6991 1.0853
TEST(FidelitySeries, IntervalsMatchDrawsOfTheErrorsThemselves) {
    FidelitySeries series;
    for (int frame = 0; frame < 9; ++frame) {
        std::vector<float> errors;
        for (int pixel = 0; pixel < 64; ++pixel) {
            const double step = (frame * 64 + pixel) * 37 % 101 / 100.0;
            errors.push_back(static_cast<float>(step * step * (0.5 + 0.125 * frame)));
        }
        series.add(with_errors(8, 8, errors, of_a_series()));
    }
    const ErrorDistribution depth = *series.result({.resamples = 8000}).depth;
    // A standard deviation of 0.04: 8000 draws know an end to 0.0012 (one sigma), and so does Python.
    expect_interval(depth.mean, 0.3361, 0.2627, 0.4172, 0.006);
    EXPECT_NEAR(depth.median.value, 0.2524, 1e-4);
    EXPECT_NEAR(depth.percentile_95.value, 0.8980, 1e-4);
    // Around the median, neighbours in the order of 64 errors are 0.016 apart, and a draw may end at either; two sigma.
    expect_interval(depth.median, 0.2524, 0.1890, 0.3381, 0.0185);
    expect_interval(depth.percentile_95, 0.8980, 0.6991, 1.0853, 0.0185);
}

TEST(FidelitySeries, OfOneFrameIsThatFrame) {
    std::vector<float> errors;
    errors.reserve(100);
    for (int i = 0; i < 100; ++i) errors.push_back(static_cast<float>(i * 37 % 101) / 100.0f);
    GbufferFidelitySettings settings;
    settings.keep_blocks = true;
    const LayerFidelity frame = with_errors(10, 10, errors, settings);
    FidelitySeries series;
    series.add(frame);
    const auto of_series = series.result().measures(), of_frame = frame.measures();
    ASSERT_EQ(of_series.size(), of_frame.size());
    for (std::size_t i = 0; i < of_frame.size(); ++i) {
        EXPECT_EQ(of_series[i].first, of_frame[i].first);
        if (!std::isnan(of_frame[i].second)) {
            EXPECT_DOUBLE_EQ(of_series[i].second, of_frame[i].second) << of_frame[i].first;
        }
    }
}

TEST(FidelitySeries, RejectsFramesWithoutBlocksAndOfAnotherSize) {
    FidelitySeries series;
    EXPECT_THROW(series.add(with_errors(2, 1, {0.0f, 0.5f})), ImageError);
    series.add(with_errors(2, 1, {0.0f, 0.5f}, of_a_series()));
    EXPECT_THROW(series.add(with_errors(3, 1, {0.0f, 0.5f, 0.5f}, of_a_series())), ImageError);
}

TEST(FidelitySeries, FramesWithoutAValueDoNotCount) {
    FidelitySeries series;
    series.add(with_errors(2, 1, {0.25f, 0.25f}, of_a_series()));
    series.add(with_errors(2, 1, {infinite, infinite}, of_a_series()));
    const ErrorDistribution depth = *series.result().depth;
    EXPECT_NEAR(depth.mean.value, 0.25, float32);
    expect_interval(depth.percentile_95, 0.25, 0.25, 0.25, 0.001);
    EXPECT_NEAR(depth.maximum, 0.25, float32);
}

}  // namespace
}  // namespace plumb

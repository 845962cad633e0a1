#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <gmock/gmock.h>

#include "frames/image_error.h"
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
    EXPECT_EQ(layer.depth->median, 0.0);
    // Of 40 ordered values the 99th percentile lies at 38.61: 0.61 of the way from 0 to the largest.
    EXPECT_NEAR(layer.depth->percentile_99, 0.61 * 0.01, float32);
    EXPECT_EQ(layer.depth->percentile_95, 0.0);
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

TEST(GbufferFidelity, OverFramesIsTheMeanAndTheLargestOfMaxima) {
    const auto all =
        fidelity_over_frames({{{"agreement", 0.5}, {"agreement_lower", 0.4}, {"depth_error_maximum", 0.25}},
                              {{"agreement", 1.0}, {"agreement_lower", 0.9}, {"depth_error_maximum", NAN}},
                              {{"depth_error_maximum", 0.75}, {"normal_angle_mean", 3.0}}});
    ASSERT_EQ(all.size(), 4u);
    EXPECT_EQ(all[0], std::pair(std::string("agreement"), 0.75));
    EXPECT_TRUE(std::isnan(all[1].second)) << "no mean of intervals is one";
    EXPECT_EQ(all[2], std::pair(std::string("depth_error_maximum"), 0.75));
    EXPECT_EQ(all[3], std::pair(std::string("normal_angle_mean"), 3.0));
    EXPECT_TRUE(fidelity_over_frames({}).empty());
}

}  // namespace
}  // namespace plumb

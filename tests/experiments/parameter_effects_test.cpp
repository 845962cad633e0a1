// A parameter that changes nothing is told with the reason; one that changes something is not.
#include "experiments/parameter_effects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/experiment_file.h"
#include "experiments/method_file.h"
#include "tests/message_of.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

Method with_true_direct_light() {
    Method method;
    method.direct.source = SourceOfStage::truth;
    return method;
}

TEST(ParameterEffects, TrueDirectLightIsThatOfTheFirstLayerOnly) {
    Method method = with_true_direct_light();
    // The method lights the second layer itself, for radiosity to gather from.
    for (const char* name : {"direct.emitters", "direct.shadow.cube_size", "direct.shadow.emitter_size"})
        EXPECT_THAT(reason_without_effect(method, name), IsEmpty()) << name;
    Method other = method;
    other.direct.shadow.cube_size = 64;
    EXPECT_NE(method_hash(method), method_hash(other));

    method.gbuffer.layers = method.ao.layers = method.radiosity.layers = 1;
    EXPECT_THAT(reason_without_effect(method, "direct.emitters"), HasSubstr("direct.source = \"truth\""));
    method.radiosity.fill = AmbientSource::probe;  // which lights what it sees
    EXPECT_THAT(reason_without_effect(method, "direct.emitters"), IsEmpty());

    method = with_true_direct_light();
    method.radiosity.layers = 1;
    const std::vector<std::string> shown = {"total", "ao"}, hidden = {"layer2.direct"};
    EXPECT_THAT(reason_without_effect(method, "direct.emitters", &shown), HasSubstr("direct.source"));
    EXPECT_THAT(reason_without_effect(method, "direct.emitters", &hidden), IsEmpty());
    EXPECT_THAT(reason_without_effect(method, "direct.emitters"), IsEmpty()) << "any plane may be asked for";
}

TEST(ParameterEffects, AGuardBandIsForWhatGathersFromIt) {
    Method method;
    method.ao.enabled = method.radiosity.enabled = false;
    EXPECT_THAT(reason_without_effect(method, "gbuffer.guard_band"), HasSubstr("reflections.enabled = false"));
    method.gbuffer.generation = LayerGeneration::reproject;
    EXPECT_THAT(reason_without_effect(method, "gbuffer.guard_band"), IsEmpty());
    method.gbuffer.generation = LayerGeneration::previous;
    EXPECT_THAT(reason_without_effect(method, "gbuffer.guard_band"), HasSubstr("ao.enabled = false"));
    method.reflections.enabled = true;
    EXPECT_THAT(reason_without_effect(method, "gbuffer.guard_band"), IsEmpty());
}

TEST(ParameterEffects, CubesNeedSomethingThatCastsShadowsIntoThem) {
    for (const char* name : {"direct.shadow.cube_generation", "direct.shadow.cube_distance"}) {
        Method method;
        EXPECT_THAT(reason_without_effect(method, name), IsEmpty());
        method.direct.emitters = false;
        EXPECT_THAT(reason_without_effect(method, name), IsEmpty()) << "lamps have cubes";
        method.direct.shadow.point_map = PointShadowMap::dual_paraboloid;
        EXPECT_THAT(reason_without_effect(method, name), HasSubstr("dual_paraboloid"));
        method.direct.emitters = true;
        EXPECT_THAT(reason_without_effect(method, name), IsEmpty()) << "emissive surfaces have cubes";
        method.direct = {.emitters = false, .shadow = {.lamps = false}};
        EXPECT_THAT(reason_without_effect(method, name), HasSubstr("direct.shadow.lamps = false"));
    }
}

TEST(ParameterEffects, NothingIsCarriedOnWhereAllIsTakenAway) {
    Method method;
    method.radiosity.carry = true;
    method.radiosity.damping = 1.0f;
    for (const char* name : {"radiosity.carry_from", "radiosity.carry_to", "radiosity.second_layer"})
        EXPECT_THAT(reason_without_effect(method, name), HasSubstr("radiosity.damping = 1")) << name;
    EXPECT_THAT(reason_without_effect(method, "radiosity.damping"), IsEmpty());
}

TEST(ParameterEffects, NothingIsFilteredOfFramesThatAreNotKept) {
    Method method;
    method.antialias = {.temporal = true, .alpha = 0.0f};
    for (const char* name : {"antialias.clamp", "antialias.reprojection", "antialias.dilate", "antialias.lookup"})
        EXPECT_THAT(reason_without_effect(method, name), HasSubstr("antialias.alpha = 0")) << name;
    for (const char* name : {"antialias.temporal", "antialias.alpha", "antialias.jitter_length"})
        EXPECT_THAT(reason_without_effect(method, name), IsEmpty()) << name << ": the view is moved all the same";
}

TEST(ParameterEffects, WhatIsNotFollowedIsLookedUpAtItsOwnPixel) {
    Method method;
    method.antialias = {.temporal = true, .reprojection = false};
    for (const char* name : {"antialias.dilate", "antialias.lookup"})
        EXPECT_THAT(reason_without_effect(method, name), HasSubstr("antialias.reprojection = false")) << name;
    for (const char* name : {"antialias.reprojection", "antialias.clamp", "antialias.alpha"})
        EXPECT_THAT(reason_without_effect(method, name), IsEmpty()) << name;
}

TEST(ParameterEffects, TheCoarsestLevelLeavesNoneToChoose) {
    Method method;
    method.radiosity.minimum_mip_level = 4;
    EXPECT_THAT(reason_without_effect(method, "radiosity.mip_offset"), IsEmpty());
    method.radiosity.minimum_mip_level = 5;
    EXPECT_THAT(reason_without_effect(method, "radiosity.mip_offset"), HasSubstr("radiosity.minimum_mip_level = 5"));
}

TEST(ParameterEffects, OneTapIsNormalisedByItself) {
    Method method;
    method.radiosity.samples = 1;
    EXPECT_THAT(reason_without_effect(method, "radiosity.normalisation"), HasSubstr("radiosity.samples = 1"));
    method.radiosity.estimator = RadiosityEstimator::nielsen2015;
    EXPECT_THAT(reason_without_effect(method, "radiosity.normalisation"), IsEmpty()) << "one in each layer";
}

TEST(ParameterEffects, AWeightRisesAgainFromTheSecondTapOn) {
    Method method;
    method.ao.blur.radius = method.radiosity.blur.radius = 1;
    EXPECT_THAT(reason_without_effect(method, "ao.blur.monotonic"), HasSubstr("ao.blur.radius = 1"));
    EXPECT_THAT(reason_without_effect(method, "radiosity.blur.monotonic"), HasSubstr("radiosity.blur.radius = 1"));
    EXPECT_THAT(reason_without_effect(method, "ao.blur.step"), IsEmpty());
    method.ao.blur.radius = 2;
    EXPECT_THAT(reason_without_effect(method, "ao.blur.monotonic"), IsEmpty());
}

TEST(ParameterEffects, ObscuranceOfNoWeightHasNoOtherParameters) {
    Method method;
    method.ao.estimator = AmbientObscuranceEstimator::nielsen2015;
    method.ao.exponent = 0.0f;
    for (const char* name : {"ao.samples", "ao.intensity", "ao.blur.radius", "ao.temporal.alpha"})
        EXPECT_THAT(reason_without_effect(method, name), HasSubstr("ao.exponent = 0")) << name;
    for (const char* name : {"ao.exponent", "ao.estimator", "ao.enabled"})
        EXPECT_THAT(reason_without_effect(method, name), IsEmpty()) << name;
    method.ao.estimator = AmbientObscuranceEstimator::linear;
    EXPECT_THAT(reason_without_effect(method, "ao.samples"), IsEmpty()) << "which has no exponent";
    method.ao.intensity = 0.0f;
    for (const char* name : {"ao.samples", "ao.estimator", "ao.layers"})
        EXPECT_THAT(reason_without_effect(method, name), HasSubstr("ao.intensity = 0")) << name;
    EXPECT_THAT(reason_without_effect(method, "ao.intensity"), IsEmpty());
    // One of the two must be printed, lest the text be another method's.
    method.ao.estimator = AmbientObscuranceEstimator::nielsen2015;
    EXPECT_THAT(reason_without_effect(method, "ao.intensity"), IsEmpty());
}

TEST(ParameterEffects, TheFormatOfLitRadianceIsForWhatTheMethodLights) {
    Method method = with_true_direct_light();
    EXPECT_THAT(reason_without_effect(method, "gbuffer.radiance_format"), HasSubstr("direct.source = \"truth\""));
    method.radiosity.bounces = 2;
    EXPECT_THAT(reason_without_effect(method, "gbuffer.radiance_format"), IsEmpty());
    method.radiosity = {.carry = true};
    EXPECT_THAT(reason_without_effect(method, "gbuffer.radiance_format"), IsEmpty());
}

TEST(ParameterEffects, LayersThatNobodyAsksForHaveNoParameters) {
    Method method;
    method.ao.layers = method.radiosity.layers = 1;
    const std::vector<std::string> first = {"total"}, second = {"total", "layer2.normal"}, third = {"layer3.depth"};
    for (const char* name : {"gbuffer.minimum_separation", "gbuffer.separation_unit", "gbuffer.generation"}) {
        EXPECT_THAT(reason_without_effect(method, name, &first), HasSubstr("no stage reads a second layer")) << name;
        EXPECT_THAT(reason_without_effect(method, name, &second), IsEmpty()) << name;
        Method reading = method;
        reading.ao.temporal = {.alpha = 0.5f, .layers = 2};
        EXPECT_THAT(reason_without_effect(reading, name, &first), IsEmpty()) << name;
    }
    method.gbuffer.layers = 3;
    EXPECT_THAT(reason_without_effect(method, "gbuffer.layers", &second), HasSubstr("no plane of layer 3"));
    EXPECT_THAT(reason_without_effect(method, "gbuffer.layers", &third), IsEmpty());
    method.gbuffer.layers = 4;
    EXPECT_THAT(reason_without_effect(method, "gbuffer.layers", &third), HasSubstr("no plane of layer 4"));
}

TEST(ParameterEffects, WhatSourcesDoOtherwiseTakesTheStageThatTheyDoItIn) {
    Method method;
    method.ao.use_mip_chain = method.radiosity.use_mip_chain = false;
    method.ao.blur.plane_sharpness = 0.0f;
    method.radiosity.blur.kind = BlurKind::gaussian_2015;
    for (const auto& [name, reason] : {std::pair{"ao.mip_points", "ao.use_mip_chain = false"},
                                       std::pair{"radiosity.mip_points", "radiosity.use_mip_chain = false"},
                                       std::pair{"ao.blur.plane_exemption", "ao.blur.plane_sharpness = 0"},
                                       std::pair{"radiosity.blur.plane_exemption", "kind is not"},
                                       std::pair{"radiosity.blur.weights", "kind is not"},
                                       std::pair{"ao.temporal.rejection", "ao.temporal.alpha = 0"},
                                       std::pair{"direct.volume_radius", "direct.local_lights = \"fullscreen\""},
                                       std::pair{"reflections.hit", "reflections.enabled = false"}}) {
        EXPECT_THAT(reason_without_effect(method, name), HasSubstr(reason)) << name;
    }
    method = {};
    method.ao.temporal.alpha = 0.5f;
    method.direct.local_lights = LocalLights::volume_stencil;
    method.reflections.enabled = true;
    for (const char* name :
         {"ao.mip_points", "radiosity.mip_points", "ao.blur.plane_exemption", "radiosity.blur.weights", "ao.pattern",
          "radiosity.pattern", "ao.temporal.rejection", "direct.volume_radius", "reflections.hit"})
        EXPECT_THAT(reason_without_effect(method, name), IsEmpty()) << name;
}

TEST(ParameterEffects, AnExperimentRefusesWhatItsPlanesDoNotShow) {
    const auto parse = [](const std::string& method) {
        const std::string text = "planes = [\"total\"]\nscenes = [{ scene = \"cornell\" }]\nmethods = [" + method + "]";
        parse_experiment(parse_config(text, "e.toml"), "e.toml");
    };
    const auto failure = [&](const std::string& method) { return message_of<ConfigError>([&] { parse(method); }); };
    EXPECT_THAT(failure("{ name = \"deep\", gbuffer.layers = 4 }"),
                AllOf(HasSubstr("e.toml:3: gbuffer.layers"), HasSubstr("no plane of layer 4")));
    EXPECT_THAT(failure("{ name = \"flat\", ao.layers = 1, radiosity.layers = 1, gbuffer.generation = \"delay\" }"),
                HasSubstr("gbuffer.generation"));
    EXPECT_NO_THROW(parse("{ name = \"deep\", gbuffer.generation = \"delay\" }"));
}

}  // namespace
}  // namespace plumb

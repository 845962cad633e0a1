#include "experiments/method_file.h"

#include <cmath>
#include <cstddef>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "method_where_it_matters.h"
#include "rasterizer/pass_plan.h"
#include "rasterizer/passes.h"
#include "scenes/builtin.h"
#include "tests/message_of.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Method read_method(const std::string& text, const MethodList& known = builtin_methods()) {
    return parse_method(parse_config(text, "m.toml"), "m.toml", known);
}

std::string method_failure(const std::string& text) {
    return message_of<ConfigError>([&] { read_method(text); });
}

// Those that stand for a publication: every parameter that they set has an effect in every scene, or they are refused.
TEST(MethodFile, PublishedMethodsRenderTheWholePictureOfEveryBuiltInScene) {
    const MethodList methods = builtin_methods();
    const Quantities quantities{.planes = {"ao", "indirect", "total"}};
    for (const char* name : {"nielsen2015", "mara2016_demo"}) {
        const Method* method = find_method(methods, name);
        ASSERT_TRUE(method) << name;
        EXPECT_EQ(method_hash(read_method(print_method(*method))), method_hash(*method)) << name;
        for (const char* scene : {"cornell", "colonnade", "clutter"}) {
            EXPECT_NO_THROW(
                plan_passes(declare_passes(make_builtin_scene(scene), *method, quantities), quantities.planes))
                << name << " in " << scene;
        }
    }
    EXPECT_EQ(find_method(methods, "nielsen2015")->radiosity.spread_pixels, 300);
    EXPECT_EQ(find_method(methods, "nielsen2015")->radiosity.pattern, TapPattern::nielsen2015);
    EXPECT_EQ(find_method(methods, "mara2016_demo")->composite.kind, CompositeKind::demo);
    EXPECT_EQ(find_method(methods, "mara2016_demo")->radiosity.temporal.rejection, HistoryRejection::mara2016);
}

TEST(MethodFile, BuiltInMethodsDifferInTheirLayersOnly) {
    const MethodList methods = builtin_methods();
    const auto differences = diff_methods(*find_method(methods, "one_layer"), *find_method(methods, "two_layers"));
    std::vector<std::string> names;
    names.reserve(differences.size());
    for (const MethodDifference& difference : differences) names.push_back(difference.parameter);
    EXPECT_THAT(names, testing::ElementsAre("gbuffer.layers", "ao.layers", "radiosity.layers"));
}

TEST(MethodFile, WhatIsNotSetComesFromTheBase) {
    const Method method = read_method("name = \"mine\"\nbase = \"one_layer\"\nao.samples = 50");
    EXPECT_EQ(method.name, "mine");
    EXPECT_EQ(method.gbuffer.layers, 1);
    EXPECT_EQ(method.ao.samples, 50);
    EXPECT_EQ(method.radiosity.samples, Method().radiosity.samples);
}

TEST(MethodFile, AnUnknownBaseIsAnErrorThatNamesTheNearest) {
    EXPECT_THAT(method_failure("name = \"mine\"\nbase = \"one_layers\""),
                AllOf(HasSubstr("m.toml:2"), HasSubstr("did you mean 'one_layer'?")));
}

TEST(MethodFile, AnUnknownParameterIsAnErrorWithLineAndNearestName) {
    EXPECT_THAT(method_failure("name = \"mine\"\n[ao]\nsampels = 3"),
                AllOf(HasSubstr("m.toml:3: ao.sampels"), HasSubstr("did you mean 'ao.samples'?")));
}

TEST(MethodFile, AnUnknownValueOfAChoiceIsAnErrorThatNamesTheNearest) {
    EXPECT_THAT(method_failure("name = \"mine\"\nao.estimator = \"mara2014\""),
                AllOf(HasSubstr("m.toml:2: ao.estimator"), HasSubstr("did you mean 'mara2016'?")));
}

TEST(MethodFile, AParameterWithoutEffectIsAnErrorThatSaysWhy) {
    EXPECT_THAT(method_failure("name = \"mine\"\nao.enabled = false\nao.samples = 3"),
                AllOf(HasSubstr("m.toml:3: ao.samples"), HasSubstr("no effect"), HasSubstr("ao.enabled = false")));
    EXPECT_THAT(method_failure("name = \"mine\"\nbase = \"one_layer\"\ngbuffer.minimum_separation = 0.2"),
                HasSubstr("gbuffer.layers = 1"));
    EXPECT_THAT(method_failure("name = \"mine\"\nradiosity.blur.radius = 0\nradiosity.blur.step = 2"),
                HasSubstr("radiosity.blur.radius = 0"));
    EXPECT_THAT(method_failure("name = \"mine\"\nao.blur.kind = \"gaussian_2015\"\nao.blur.plane_sharpness = 2.0"),
                HasSubstr("ao.blur.kind is not \"bilateral\""));
    EXPECT_THAT(method_failure("name = \"mine\"\nao.temporal.layers = 2"), HasSubstr("ao.temporal.alpha = 0"));
    EXPECT_THAT(method_failure("name = \"mine\"\nradiosity.temporal.vary_taps = false"),
                HasSubstr("radiosity.temporal.alpha = 0"));
    EXPECT_THAT(method_failure("name = \"mine\"\nantialias.clamp = false"), HasSubstr("antialias.temporal = false"));
}

TEST(MethodFile, MoreLayersThanTheGBufferHoldsIsAnError) {
    EXPECT_THAT(method_failure("name = \"mine\"\nbase = \"one_layer\"\nao.layers = 2"),
                AllOf(HasSubstr("ao.layers = 2"), HasSubstr("gbuffer.layers = 1")));
}

TEST(MethodFile, EveryParameterIsPrintedAndComesBack) {
    // Each parameter in turn takes another value than its default and must survive print and parse.
    const std::vector<std::string> parameter_names = method_parameter_names();
    for (std::size_t i = 0; i < parameter_names.size(); ++i) {
        const Method defaults = method_where_it_matters(parameter_names[i]);
        EXPECT_EQ(reason_without_effect(defaults, parameter_names[i]), "") << parameter_names[i];
        Method method = defaults;
        const MethodParameter parameter = method_parameters(method)[i];
        if (bool* const* value = std::get_if<bool*>(&parameter.value)) **value = !**value;
        if (int* const* value = std::get_if<int*>(&parameter.value))
            **value = **value == parameter.least ? **value + 1 : **value - 1;
        if (float* const* value = std::get_if<float*>(&parameter.value)) **value = **value * 1.1f + 0.013f;
        if (const auto* value = std::get_if<MethodChoice>(&parameter.value)) {
            value->set((value->get() + 1) % static_cast<int>(value->names.size()));
        }
        if (method.gbuffer.layers == 1) method.ao.layers = method.radiosity.layers = 1;  // the only valid combination
        method.name = "changed";
        const std::string text = print_method(method);
        const Method again = read_method(text, {});
        EXPECT_EQ(print_method(again), text) << parameter.name;
        EXPECT_NE(method_hash(method), method_hash(defaults)) << parameter.name;
        EXPECT_EQ(method_hash(method), method_hash(again)) << parameter.name;
    }
}

TEST(MethodFile, NoSettingIsMissingFromTheListOfParameters) {
    // Every setting takes 4 bytes (a truth value is padded to 4, as none follows another). Where this fails,
    // method_parameters() lacks a parameter that method.h has gained.
    const std::size_t settings = sizeof(GBufferSettings) + sizeof(DirectSettings) + sizeof(EnvironmentSettings) +
                                 sizeof(ProbeSettings) + sizeof(AmbientObscuranceSettings) + sizeof(RadiositySettings) +
                                 sizeof(AntialiasSettings) + sizeof(CompositeSettings) + sizeof(ReflectionSettings);
    EXPECT_EQ(4 * method_parameter_names().size(), settings);
}

TEST(MethodFile, NamesAreUniqueAndChoicesCoverTheirValues) {
    const auto names = method_parameter_names();
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
    Method method;
    for (const MethodParameter& parameter : method_parameters(method)) {
        const auto* choice = std::get_if<MethodChoice>(&parameter.value);
        if (!choice) continue;
        EXPECT_LT(choice->get(), static_cast<int>(choice->names.size())) << parameter.name;
    }
}

TEST(MethodFile, TheHashIgnoresTheNameAndParametersWithoutEffect) {
    Method first, second;
    second.name = "another name";
    EXPECT_EQ(method_hash(first), method_hash(second));
    first.ao.enabled = second.ao.enabled = false;
    second.ao.samples = 99;
    EXPECT_EQ(method_hash(first), method_hash(second));
}

TEST(MethodFile, ACommandLineAssignmentSetsOneParameter) {
    Method method;
    set_method_parameter(method, "ao.samples=6");
    set_method_parameter(method, "ao.estimator=linear");
    set_method_parameter(method, "radiosity.radius=inf");
    set_method_parameter(method, "ao.use_mip_chain=false");
    EXPECT_EQ(method.ao.samples, 6);
    EXPECT_EQ(method.ao.estimator, AmbientObscuranceEstimator::linear);
    EXPECT_TRUE(std::isinf(method.radiosity.radius));
    EXPECT_FALSE(method.ao.use_mip_chain);
    EXPECT_THAT(message_of<ConfigError>([&] { set_method_parameter(method, "ao.samples"); }), HasSubstr("name=value"));
    EXPECT_THAT(message_of<ConfigError>([&] { set_method_parameter(method, "ao.mip_offset=2"); }),
                HasSubstr("no effect"));
    EXPECT_THAT(message_of<ConfigError>([&] { set_method_parameter(method, "ao.samples=0"); }),
                HasSubstr("must be 1 to 1000"));
}

TEST(MethodFile, TheOrderOfAssignmentsMeansNothing) {
    const auto failure = [](const std::vector<std::string>& assignments) {
        Method method;
        return message_of<ConfigError>([&] { set_method_parameters(method, assignments); });
    };
    for (const auto& assignments : {std::vector<std::string>{"ao.samples=50", "ao.enabled=false"},
                                    std::vector<std::string>{"ao.enabled=false", "ao.samples=50"}})
        EXPECT_THAT(failure(assignments), AllOf(HasSubstr("'ao.samples=50'"), HasSubstr("ao.enabled = false")));
    Method method;
    set_method_parameters(method, {"radiosity.ambient=0.3", "radiosity.fill=ambient"});
    EXPECT_EQ(method.radiosity.ambient, 0.3f);
    EXPECT_EQ(method.radiosity.fill, AmbientSource::ambient);
    EXPECT_THAT(failure({"ao.samples=5", "ao.bias=0.1", "ao.samples=6"}),
                AllOf(HasSubstr("'ao.samples=5'"), HasSubstr("'ao.samples=6'")));
}

TEST(MethodFile, AScenesOverridesLeaveMethodsTheyDoNotConcern) {
    const ConfigValue table = parse_config("ao.bias = 0.5\ngbuffer.minimum_separation = 0.7", "s.toml");
    Method one = *find_method(builtin_methods(), "one_layer");
    override_method(one, table, "s.toml");
    EXPECT_EQ(one.ao.bias, 0.5f);
    EXPECT_EQ(one.gbuffer.minimum_separation, Method().gbuffer.minimum_separation);
}

TEST(MethodFile, TheOrderOfAScenesOverridesMeansNothing) {
    Method method;
    override_method(method, parse_config("radiosity.ambient = 0.3\nradiosity.fill = \"ambient\"", "s.toml"), "s.toml");
    EXPECT_EQ(method.radiosity.ambient, 0.3f);
}

TEST(MethodFile, AnOverrideThatConcernsNoMethodIsAnError) {
    const MethodList both = builtin_methods(), flat = {*find_method(both, "one_layer")};
    const ConfigValue table = parse_config("ao.bias = 0.5\ngbuffer.minimum_separation = 0.7", "s.toml");
    EXPECT_NO_THROW(require_effective_overrides(both, table, "s.toml"));
    EXPECT_THAT(message_of<ConfigError>([&] { require_effective_overrides(flat, table, "s.toml"); }),
                AllOf(HasSubstr("s.toml:2: method.gbuffer.minimum_separation"), HasSubstr("'one_layer'"),
                      HasSubstr("gbuffer.layers = 1")));
}

}  // namespace
}  // namespace plumb

// What the planes that are asked for do not show, and what the scenes have nothing for, is told: by the passes.
#include "experiments/parameter_reach.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/experiment_file.h"
#include "experiments/loaded_scenes.h"
#include "experiments/method_file.h"
#include "method_where_it_matters.h"
#include "rasterizer/passes.h"
#include "scenes/builtin.h"
#include "tests/message_of.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

using Planes = std::vector<std::string>;

std::string reason(const Method& method, std::string_view name, const Planes& planes, const Scene* scene = nullptr) {
    return reason_without_effect(method, name, &planes, scene);
}

TEST(ParameterReach, EveryParameterIsReadByAPassAndPassesNameNoOthers) {
    const std::vector<std::string> names = method_parameter_names();
    const Scene everything = make_scene_of_everything();
    for (const std::string& name : names) {
        const Method method = method_where_it_matters(name);
        EXPECT_EQ(reason_nobody_reads(method, name, nullptr, everything), "") << name;
        for (const PassDeclaration& pass : declare_passes(everything, method, {})) {
            for (const ParameterUse& use : pass.parameters) {
                EXPECT_TRUE(std::ranges::any_of(names,
                                                [&](const std::string& known) {
                                                    return use.name.ends_with('.') ? known.starts_with(use.name)
                                                                                   : known == use.name;
                                                }))
                    << pass.name << " reads " << use.name;
                for (const std::string& plane : use.planes) {
                    // Which shadow maps and positions there are depends on scene and method.
                    if (plane.starts_with("shadow.") || plane.ends_with("camera_position")) continue;
                    EXPECT_NE(std::ranges::find(pass.outputs, plane), pass.outputs.end())
                        << pass.name << " gives no " << plane;
                }
            }
        }
    }
}

TEST(ParameterReach, StagesThatThePlanesDoNotShowHaveNoParameters) {
    const Planes visibility = {"ao"}, bounced = {"indirect"}, both = {"ao", "indirect"};
    for (const char* name : {"radiosity.samples", "radiosity.enabled", "radiosity.blur.radius", "reflections.enabled",
                             "composite.kind", "gbuffer.radiance_format", "antialias.temporal", "direct.shadow.bias"})
        EXPECT_THAT(reason(Method(), name, visibility), AllOf(HasSubstr("ao is asked for"), HasSubstr("does not run")))
            << name;
    for (const char* name : {"reflections.enabled", "composite.kind", "antialias.temporal"})
        EXPECT_THAT(reason(Method(), name, bounced), HasSubstr("indirect is asked for")) << name;
    for (const char* name : {"radiosity.samples", "gbuffer.radiance_format", "direct.shadow.bias"})
        EXPECT_THAT(reason(Method(), name, both), IsEmpty()) << name;
    Method method;
    method.antialias.temporal = method.reflections.enabled = true;
    for (const char* name : {"antialias.alpha", "reflections.step", "gbuffer.normal_format"})
        EXPECT_THAT(reason(method, name, {"depth"}), HasSubstr("depth is asked for")) << name;
    for (const char* name : {"antialias.alpha", "reflections.step"})
        EXPECT_THAT(reason(method, name, {"total"}), IsEmpty()) << name;
}

TEST(ParameterReach, PlanesOfOneStageShowDifferentParametersOfIt) {
    const Planes irradiance = {"irradiance"}, first = {"indirect.1"}, indirect = {"indirect"};
    Method method;
    EXPECT_THAT(reason(method, "radiosity.saturated_boost", irradiance), HasSubstr("nobody reads indirect"));
    EXPECT_THAT(reason(method, "radiosity.saturated_boost", first), IsEmpty());
    EXPECT_THAT(reason(method, "radiosity.saturated_boost", indirect), IsEmpty());
    method.radiosity.bounces = 2;  // of which the second gathers what is reflected of the first
    EXPECT_THAT(reason(method, "radiosity.saturated_boost", irradiance), IsEmpty());
    method.radiosity.fill = AmbientSource::ambient;
    EXPECT_THAT(reason(method, "radiosity.ambient", first), HasSubstr("indirect.1 is asked for"));
    EXPECT_THAT(reason(method, "radiosity.ambient", irradiance), IsEmpty());
}

TEST(ParameterReach, ObscuranceDimsWhereThereIsAnEnvironment) {
    const Planes indirect = {"indirect"};
    const Scene cornell = make_builtin_scene("cornell"), everything = make_scene_of_everything();
    ASSERT_TRUE(cornell.environment.is_black());
    EXPECT_THAT(reason(Method(), "ao.samples", indirect), IsEmpty()) << "some scene may have one";
    EXPECT_THAT(reason(Method(), "ao.samples", indirect, &everything), IsEmpty());
    EXPECT_THAT(reason(Method(), "ao.samples", indirect, &cornell),
                AllOf(HasSubstr("nothing in scene 'cornell'"), HasSubstr("ambient obscurance")));
}

TEST(ParameterReach, WhatASceneLacksIsTold) {
    Scene scene = make_scene_of_everything();
    Method method;
    method.reflections.enabled = true;
    const Planes total = {"total"};
    const auto expect_both = [&](const Method& of, const char* name, const auto& take_away) {
        EXPECT_THAT(reason(of, name, total, &scene), IsEmpty()) << name;
        Scene without = scene;
        take_away(without);
        EXPECT_THAT(reason(of, name, total, &without), HasSubstr("nothing in scene 'everything'")) << name;
    };
    const auto no_flat_maps = [](Scene& s) {
        s.directional_lights.clear(), s.spot_lights.erase(s.spot_lights.begin());
    };
    for (const char* name : {"direct.shadow.map_size", "direct.shadow.pcf_radius"})
        expect_both(method, name, no_flat_maps);
    const auto no_lamps = [](Scene& s) { s.point_lights.clear(), s.spot_lights.clear(); };
    for (const char* name : {"direct.local_lights", "direct.shadow.cube_size", "direct.shadow.lamps"})
        expect_both(method, name, no_lamps);
    const auto matt = [](Scene& s) { s.materials[0].metallic = 0.0f; };
    for (const char* name : {"reflections.step", "reflections.lamps", "reflections.enabled"})
        expect_both(method, name, matt);
    const auto dark = [](Scene& s) { s.materials[1].emission = glm::vec3(0.0f); };
    expect_both(method, "direct.emitters", dark);
    expect_both(method, "direct.shadow.emitter_size", dark);
    Method shining = method;
    shining.direct.emitters = false, shining.radiosity.emitters_shine = true;
    expect_both(shining, "radiosity.emitters_shine", dark);
    Method filled = method;
    filled.radiosity.fill = AmbientSource::probe, filled.probe.every_frame = true;
    expect_both(filled, "probe.every_frame", [](Scene& s) { s.instances[0].motion = {}; });
    Method cube = method;
    cube.direct.environment = EnvironmentIrradiance::cube;
    expect_both(cube, "environment.size", [](Scene& s) { s.environment.texture = no_texture; });
}

TEST(ParameterReach, AProbeShowsWhatItsFacesShow) {
    const Scene scene = make_scene_of_everything();
    Method method;
    method.direct.source = SourceOfStage::truth;
    method.gbuffer.layers = method.ao.layers = method.radiosity.layers = 1;
    const Planes irradiance = {"irradiance"};
    EXPECT_THAT(reason(method, "ao.samples", irradiance, &scene), HasSubstr("does not run"));
    method.radiosity.fill = AmbientSource::probe;
    EXPECT_THAT(reason(method, "ao.samples", irradiance, &scene), IsEmpty()) << "which dims their environment";
    EXPECT_THAT(reason(method, "direct.shadow.map_size", irradiance, &scene), IsEmpty());
    EXPECT_THAT(reason(method, "composite.kind", irradiance, &scene), HasSubstr("does not run"));
}

Experiment parse_text(const std::string& text) { return parse_experiment(parse_config(text, "e.toml"), "e.toml"); }

Experiment parse_of(const std::string& planes, const std::string& methods, const std::string& scenes) {
    return parse_text("planes = [" + planes + "]\nscenes = [" + scenes + "]\nmethods = [" + methods + "]");
}

std::string failure_of(const std::string& planes, const std::string& methods,
                       const std::string& scenes = "{ scene = \"cornell\" }") {
    return message_of<ConfigError>([&] { parse_of(planes, methods, scenes); });
}

TEST(ParameterReach, AnExperimentRefusesStagesThatItsPlanesDoNotShow) {
    EXPECT_THAT(failure_of("\"ao\"", "{ name = \"m\", radiosity.samples = 4 }"),
                AllOf(HasSubstr("e.toml:3: radiosity.samples"), HasSubstr("ao is asked for")));
    EXPECT_THAT(failure_of("\"ao\", \"depth\"", "{ name = \"m\", antialias.temporal = true }"),
                AllOf(HasSubstr("antialias.temporal"), HasSubstr("ao, depth is asked for")));
    EXPECT_NO_THROW(
        parse_of("\"ao\", \"indirect\"", "{ name = \"m\", radiosity.samples = 4 }", "{ scene = \"cornell\" }"));
}

TEST(ParameterReach, OnlyStagesThatThePlanesShowMustBeGivenTheirLayers) {
    const std::string flat = "gbuffer.layers = 1, ao.layers = 1";
    EXPECT_NO_THROW(parse_of("\"ao\"", "{ name = \"m\", " + flat + " }", "{ scene = \"cornell\" }"));
    EXPECT_THAT(failure_of("\"ao\", \"indirect\"", "{ name = \"m\", " + flat + " }"),
                HasSubstr("radiosity.layers = 2 cannot be combined with gbuffer.layers = 1"));
}

TEST(ParameterReach, EachValueOfASweepIsARowOfItsOwn) {
    EXPECT_THAT(failure_of("\"ao\"", "{ name = \"m\", sweep = { \"radiosity.samples\" = [4, 8] } }"),
                AllOf(HasSubstr("e.toml:3: radiosity.samples"), HasSubstr("'m, radiosity.samples = 4'")));
    EXPECT_THAT(failure_of("\"ao\"", "{ name = \"m\", ao.samples = 3, sweep = { \"ao.samples\" = [4, 8] } }"),
                HasSubstr("is set beside it"));
    // What is set beside it matters at some of its values.
    EXPECT_NO_THROW(parse_of("\"ao\"", "{ name = \"m\", ao.blur.step = 2, sweep = { \"ao.blur.radius\" = [0, 4] } }",
                             "{ scene = \"cornell\" }"));
    EXPECT_THAT(
        failure_of("\"ao\"",
                   "{ name = \"m\", ao.blur.radius = 0, ao.blur.step = 2, sweep = { \"ao.samples\" = [4, 8] } }"),
        HasSubstr("ao.blur.radius = 0"));
}

TEST(ParameterReach, MethodsThatThePlanesCannotTellApartAreRefused) {
    const std::string two = "{ name = \"a\", base = \"two_layers\" }, \"nielsen2015\"";
    EXPECT_NO_THROW(parse_of("\"ao\"", two, "{ scene = \"cornell\" }"));
    EXPECT_NO_THROW(
        parse_of("\"ao\"", "\"two_layers\", { name = \"again\", base = \"two_layers\" }", "{ scene = \"cornell\" }"))
        << "the very same one: to see how far its times spread";
}

TEST(ParameterReach, WhatNoSceneOfAnExperimentHasAnythingForIsTold) {
    const SceneFinder finder({});
    const auto check = [&](const std::string& methods, const std::string& scenes) {
        LoadedScenes loaded(finder);
        require_effects_in_scenes(parse_of("\"direct\"", methods, scenes), loaded);
    };
    const std::string large_maps = "{ name = \"m\", direct.shadow.map_size = 512 }";
    EXPECT_THAT(message_of<ConfigError>([&] { check(large_maps, "{ scene = \"cornell\" }"); }),
                AllOf(HasSubstr("e.toml:3: direct.shadow.map_size"), HasSubstr("in any of the scenes"),
                      HasSubstr("nothing in scene 'cornell'")));
    EXPECT_NO_THROW(check(large_maps, "{ scene = \"cornell\" }, { scene = \"colonnade\" }")) << "which has a sun";
    EXPECT_NO_THROW(check(large_maps, "{ scene = \"cornell\" }, { scene = \"nowhere.toml\" }")) << "who knows";
    EXPECT_THAT(message_of<ConfigError>([&] {
                    check("\"two_layers\"",
                          "{ scene = \"colonnade\" }, { scene = \"cornell\", "
                          "method.direct.shadow.map_size = 512 }");
                }),
                AllOf(HasSubstr("e.toml:2: method.direct.shadow.map_size"), HasSubstr("nothing in scene 'cornell'")));
}

TEST(ParameterReach, AnOverrideThatThePlanesDoNotShowIsRefused) {
    EXPECT_THAT(failure_of("\"ao\"", "\"two_layers\"", "{ scene = \"cornell\", method.direct.shadow.bias = 0.001 }"),
                AllOf(HasSubstr("e.toml:2: method.direct.shadow.bias"), HasSubstr("ao is asked for")));
}

}  // namespace
}  // namespace plumb

// Which parameters of reflections, and of what they read, have an effect when.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/method_parameters.h"
#include "experiments/parameter_effects.h"

namespace plumb {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(ReflectionParameters, ChangeNothingWhileReflectionsAreOff) {
    const Method method;
    for (const std::string& name : method_parameter_names()) {
        if (!name.starts_with("reflections.") || name == "reflections.enabled") continue;
        EXPECT_THAT(reason_without_effect(method, name), HasSubstr("reflections.enabled = false")) << name;
    }
}

TEST(ReflectionParameters, SamplesMatterWhereRoughnessIsSampled) {
    Method method;
    method.reflections.enabled = true;
    EXPECT_THAT(reason_without_effect(method, "reflections.samples"), HasSubstr("\"samples\""));
    method.reflections.roughness = ReflectionRoughness::samples;
    EXPECT_THAT(reason_without_effect(method, "reflections.samples"), IsEmpty());
}

TEST(ReflectionParameters, AStepFollowsTheFirstOne) {
    Method method;
    method.reflections.enabled = true;
    method.reflections.max_steps = 1;
    EXPECT_THAT(reason_without_effect(method, "reflections.step"), HasSubstr("reflections.max_steps = 1"));
    EXPECT_THAT(reason_without_effect(method, "reflections.first_step"), IsEmpty());
    method.reflections.max_steps = 2;
    EXPECT_THAT(reason_without_effect(method, "reflections.step"), IsEmpty());
}

TEST(ReflectionParameters, CubesMatterWhereTheFallbackReadsThem) {
    Method method;
    method.reflections.enabled = true;
    EXPECT_THAT(reason_without_effect(method, "probe.size"), HasSubstr("reflections.fallback"));
    EXPECT_THAT(reason_without_effect(method, "environment.samples"), HasSubstr("reflections.fallback"));
    method.reflections.fallback = ReflectionFallback::probe;
    EXPECT_THAT(reason_without_effect(method, "probe.size"), IsEmpty());
    EXPECT_THAT(reason_without_effect(method, "environment.samples"), IsEmpty());
    EXPECT_THAT(reason_without_effect(method, "environment.size"), HasSubstr("reflections.fallback"));
    method.reflections.fallback = ReflectionFallback::environment;
    EXPECT_THAT(reason_without_effect(method, "environment.size"), IsEmpty());
    method.reflections.roughness = ReflectionRoughness::samples;
    EXPECT_THAT(reason_without_effect(method, "environment.samples"), HasSubstr("sharpest level"));
}

TEST(ReflectionParameters, TheSeparationMattersWhereItIsTheThicknessOfSurfaces) {
    Method method;
    method.gbuffer.layers = 1;
    EXPECT_THAT(reason_without_effect(method, "gbuffer.minimum_separation"), HasSubstr("gbuffer.layers = 1"));
    method.reflections.enabled = true;
    EXPECT_THAT(reason_without_effect(method, "gbuffer.minimum_separation"), IsEmpty());
    method.reflections.thickness = 0.2f;
    EXPECT_THAT(reason_without_effect(method, "gbuffer.minimum_separation"), HasSubstr("gbuffer.layers = 1"));
}

TEST(ReflectionParameters, ShadowsOfHighlightsMatterWhereverDirectLightComesFrom) {
    Method method;
    method.direct.source = SourceOfStage::truth;
    method.gbuffer.layers = 1;  // else the method lights the second one itself
    EXPECT_THAT(reason_without_effect(method, "direct.shadow.cube_size"), HasSubstr("direct.source"));
    method.reflections.enabled = true;
    EXPECT_THAT(reason_without_effect(method, "direct.shadow.cube_size"), IsEmpty());
    method.reflections.lamps = false;
    EXPECT_THAT(reason_without_effect(method, "direct.shadow.cube_size"), HasSubstr("direct.source"));
}

}  // namespace
}  // namespace plumb

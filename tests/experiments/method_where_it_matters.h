// For tests that go through all parameters of a method.
#pragma once

#include <string_view>

#include "rasterizer/method.h"

namespace plumb {

// The default method with that changed without which parameter `name` has no effect.
inline Method method_where_it_matters(std::string_view name) {
    Method method;
    if (name.starts_with("direct.shadow.paraboloid_")) {
        method.direct.shadow.point_map = PointShadowMap::dual_paraboloid;
    }
    if (name.starts_with("direct.volume_")) method.direct.local_lights = LocalLights::volume;
    if (name == "gbuffer.layer_selection") method.gbuffer.generation = LayerGeneration::delay;
    if (name == "radiosity.blur.depth_key_bits") method.radiosity.blur.depth_sharpness = 10.0f;
    if (name == "environment.size") method.direct.environment = EnvironmentIrradiance::cube;
    if (name.starts_with("probe.")) method.radiosity.fill = AmbientSource::probe;
    if (name == "radiosity.second_layer") method.radiosity.bounces = 2;
    if (name == "radiosity.damping" || name.starts_with("radiosity.carry_")) method.radiosity.carry = true;
    if (name == "radiosity.ambient") method.radiosity.fill = AmbientSource::ambient;
    if (name == "composite.fill" || name == "composite.ambient") {
        method.composite = {.kind = CompositeKind::demo, .fill = AmbientSource::ambient};
    }
    if (name.starts_with("reflections.") || name == "environment.samples") method.reflections.enabled = true;
    if (name == "reflections.samples") method.reflections.roughness = ReflectionRoughness::samples;
    if (name == "reflections.max_distance") method.reflections.max_distance = 10.0f;
    if (name == "environment.samples") method.reflections.fallback = ReflectionFallback::environment;
    if (name.starts_with("ao.temporal.")) method.ao.temporal.alpha = 0.5f;
    if (name.starts_with("radiosity.temporal.")) method.radiosity.temporal.alpha = 0.5f;
    if (name.starts_with("antialias.")) method.antialias.temporal = true;
    if (name == "antialias.alpha") method.antialias.alpha = 0.5f;
    if (name == "ao.exponent") method.ao.estimator = AmbientObscuranceEstimator::alchemy2011;
    return method;
}

}  // namespace plumb

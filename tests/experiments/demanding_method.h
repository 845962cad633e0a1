// The method of two layers that takes the most of OpenGL's memory, and a scene that makes it take it.
#pragma once

#include <cstddef>

#include "rasterizer/gl_context.h"
#include "rasterizer/pipeline.h"
#include "scenes/scene_file.h"

namespace plumb {

// The cluttered room with things that move, all of it glossy, under a sky: every plane is called for.
inline Scene make_demanding_scene() {
    Scene scene = load_scene("clutter-moving", {});
    for (Material& material : scene.materials) material.dielectric_reflectance = 0.04f;
    scene.environment.radiance = glm::vec3(0.5f);
    return scene;
}

// Every stage at once, each with what it keeps from frame to frame.
inline Method with_everything_on() {
    Method method;
    method.ao.temporal.alpha = method.radiosity.temporal.alpha = 0.85f;
    method.ao.blur.depth_key_bits = 16;
    method.radiosity.bounces = 2;
    method.radiosity.fill = AmbientSource::probe;
    method.reflections = {.enabled = true, .fallback = ReflectionFallback::probe};
    method.antialias.temporal = true;
    method.probe.y = 1.5f;
    return method;
}

// And of every choice the one that takes the most, but for formats wider than by default (method_memory_test.cpp), as
// long as nothing has more texels than by default and light bounces twice (dearest_method_test.cpp looks for one that
// takes more).
inline Method dearest_method() {
    Method method = with_everything_on();
    method.name = "dearest";
    method.gbuffer.generation = LayerGeneration::delay;
    method.direct.local_lights = LocalLights::volume_stencil;
    method.direct.environment = EnvironmentIrradiance::cube;
    method.ao.blur.depth_key_bits = 8;  // the other's memory serves others later
    method.radiosity.mip_normals_and_radiance = true;
    method.radiosity.second_layer = SecondLayerIndirect::gather;
    return method;
}

// What a pipeline of 1280x720 takes that shows its picture and tells of its motion.
inline double mebibytes_of(GlContext& context, const Scene& scene, const Method& method) {
    const std::size_t before = context.allocated_bytes();
    const Pipeline pipeline(context, scene, method, {.planes = {"total", "ao", "motion"}}, 1280, 720);
    return static_cast<double>(context.allocated_bytes() - before) / (1024.0 * 1024.0);
}

}  // namespace plumb

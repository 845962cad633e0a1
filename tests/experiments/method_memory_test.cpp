// What the methods that come with the program, and the dearest ones, take of OpenGL's memory.
#include <memory>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "experiments/method_file.h"
#include "rasterizer/gl_context.h"
#include "rasterizer/pipeline.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

// Every stage at once, each with what it keeps from frame to frame.
Method with_everything_on() {
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

TEST(MethodMemory, TwoLayersAt720LinesStayBelow400Mebibytes) {
    const std::unique_ptr<GlContext> context = GlContext::create();
    MethodList methods = builtin_methods();
    Method everything = with_everything_on();
    everything.name = "everything on";
    methods.push_back(everything);
    for (const LayerGeneration generation : {LayerGeneration::delay, LayerGeneration::reproject}) {
        Method one_pass = *find_method(methods, "two_layers");
        one_pass.gbuffer.generation = generation;
        one_pass.name = generation == LayerGeneration::delay ? "delay" : "reproject";
        methods.push_back(one_pass);
    }
    for (const char* scene_name : {"colonnade", "clutter"}) {
        const Scene scene = make_builtin_scene(scene_name);
        for (const Method& method : methods) {
            const std::size_t before = context->allocated_bytes();
            std::vector<std::string> planes = {"total", "ao"};
            if (method.antialias.temporal) planes.emplace_back("motion");
            Pipeline pipeline(*context, scene, method, {.planes = planes}, 1280, 720);
            const double mebibytes = static_cast<double>(context->allocated_bytes() - before) / (1024.0 * 1024.0);
            fmt::print("{} in {}: {:.0f} MiB\n", method.name, scene_name, mebibytes);
            EXPECT_LT(mebibytes, 400.0) << method.name << " in " << scene_name;
        }
    }
}

}  // namespace
}  // namespace plumb

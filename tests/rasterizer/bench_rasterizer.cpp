// Milliseconds of each pass at three sizes, on the colonnade: `bench_rasterizer --benchmark_filter=direct`.
// Light volumes, shadow maps by kind and further bounces have benchmarks of their own (bench_lights, bench_radiosity).
//
// `taps` are the texels that a pass looks at for all pixels, each layer by itself: what it would cost per tap is
// `ns_per_tap`. Of `direct` and `lamp highlights` they are the lights that are evaluated, of rays the most steps that
// they may take; passes that read each plane once, or draw triangles, have none.
// Only the passes that the measured one needs run with it. Times are the pipeline's own (GPU timer queries, or glFinish
// and the steady clock on a software rasteriser), without read-back.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "rasterizer/gl_context.h"
#include "rasterizer/light_set.h"
#include "rasterizer/pipeline.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

struct PassCase {
    const char* pass;
    std::vector<std::string> planes;  // what to ask for, so that the pass runs
    std::function<void(Method&)> change = [](Method&) {};
    std::function<double(const Method&)> taps_per_pixel = [](const Method&) { return 0.0; };
};

double taps_of_obscurance(const Method& method) { return static_cast<double>(method.ao.samples) * method.ao.layers; }

double taps_of_radiosity(const Method& method) {
    return static_cast<double>(method.radiosity.samples) * method.radiosity.layers;
}

double taps_of_blur(const BilateralBlurSettings& blur) { return 2.0 * (2 * blur.radius + 1); }

// A copy, and a texel of each coarser level.
double texels_of_chain(const Method&) { return 4.0 / 3.0; }

// Of the colonnade: a sun and a lamp.
double lights(const Method&) { return 2.0; }

// A texel of every level, and the four finer ones that each coarser texel averages.
double texels_of_radiance_chain(const Method& method) { return method.reflections.layers * (1.0 + 4.0 / 3.0); }

double steps_of_rays(const Method& method) {
    return static_cast<double>(method.reflections.max_steps) * method.reflections.layers;
}

// The nine of the clamp, and sixteen of the history.
double taps_of_antialias(const Method&) { return 25.0; }

// Rays that end at once, where the time of a pass beside them is asked for.
void reflect_shortly(Method& method) { method.reflections.enabled = true, method.reflections.max_steps = 8; }

void reflect_probe(Method& method) {
    reflect_shortly(method);
    method.reflections.fallback = ReflectionFallback::probe;
    method.probe.y = 2.0f, method.probe.every_frame = true;
}

void nothing_else(Method&) {}
void chain_all(Method& method) { method.radiosity.mip_normals_and_radiance = true; }

const std::vector<PassCase> pass_cases{
    {"gbuffer", {"depth", "normal", "albedo"}},
    {"gbuffer.layer2", {"layer2.depth", "layer2.normal", "layer2.albedo"}},
    {"motion", {"motion"}},
    {"depth MIP chain", {"ao"}, nothing_else, texels_of_chain},
    {"depth keys of 8 bits", {"ao"}, [](Method& method) { method.ao.blur.depth_key_bits = 8; }},
    {"depth keys of 16 bits", {"ao"}, [](Method& method) { method.ao.blur.depth_key_bits = 16; }},
    {"normal MIP chain", {"indirect"}, chain_all, texels_of_chain},
    {"direct MIP chain", {"indirect"}, chain_all, texels_of_chain},
    {"ambient obscurance", {"ao"}, nothing_else, taps_of_obscurance},
    {"ambient obscurance blur",
     {"ao"},
     nothing_else,
     [](const Method& method) { return taps_of_blur(method.ao.blur); }},
    {"light volumes", {"direct"}, [](Method& method) { method.direct.local_lights = LocalLights::volume_stencil; }},
    {"direct", {"direct"}, nothing_else, lights},
    {"direct.layer2", {"layer2.direct"}, nothing_else, lights},
    {"radiosity", {"indirect"}, nothing_else, taps_of_radiosity},
    {"radiosity blur",
     {"indirect"},
     nothing_else,
     [](const Method& method) { return taps_of_blur(method.radiosity.blur); }},
    {"radiosity reflection", {"indirect"}},
    // The depth of each layer where the point was before.
    {"radiosity carried on",
     {"indirect"},
     [](Method& method) { method.radiosity.carry = true; },
     [](const Method& method) { return static_cast<double>(method.radiosity.layers); }},
    {"lamp highlights", {"reflection"}, reflect_shortly, lights},
    {"radiance MIP chain", {"reflection"}, reflect_shortly, texels_of_radiance_chain},
    {"reflections", {"reflection"}, [](Method& method) { method.reflections.enabled = true; }, steps_of_rays},
    {"probe", {"reflection"}, reflect_probe},
    {"composite", {"total"}},
    {"temporal antialias", {"total"}, [](Method& method) { method.antialias.temporal = true; }, taps_of_antialias},
};

// Every surface slightly glossy, so that reflections have something to do.
Scene colonnade() {
    Scene scene = make_builtin_scene("colonnade");
    for (Material& material : scene.materials) material.dielectric_reflectance = 0.04f, material.roughness = 0.3f;
    return scene;
}

// What `pass` takes of the next frame, in seconds; negative and an error where it does not run.
double seconds_of(const char* pass, Pipeline& pipeline, const View& view, benchmark::State& state) {
    const std::vector<PassTiming> timings = pipeline.time_passes(view);
    const auto timing = std::ranges::find(timings, pass, &PassTiming::pass);
    if (timing != timings.end()) return 1e-3 * timing->milliseconds;
    state.SkipWithError("the pass did not run");
    return -1.0;
}

void measure(benchmark::State& state, GlContext& context, const Scene& scene, const PassCase& pass_case) {
    const int height = static_cast<int>(state.range(0)), width = height * 16 / 9;
    Quantities quantities;
    quantities.planes = pass_case.planes;
    Method method;
    pass_case.change(method);
    Pipeline pipeline(context, scene, method, quantities, width, height);
    const View view(scene.camera("court"), width, height);
    pipeline.time_passes(view);  // the first frame compiles what drivers compile late
    double total = 0.0;
    for (auto _ : state) {
        const double seconds = seconds_of(pass_case.pass, pipeline, view, state);
        if (seconds < 0.0) return;
        state.SetIterationTime(seconds);
        total += seconds;
    }
    const double pixels = static_cast<double>(width) * height, taps = pixels * pass_case.taps_per_pixel(method);
    state.counters["pixels"] = pixels;
    if (taps > 0.0) {
        state.counters["taps"] = taps;
        state.counters["ns_per_tap"] = 1e9 * total / (static_cast<double>(state.iterations()) * taps);
    }
    state.counters["GL_MiB"] = static_cast<double>(context.allocated_bytes()) / (1024.0 * 1024.0);
}

// Shadow maps of all lights, whatever the image's size: the sun's of `size` texels a side, a lamp's cube of half as
// many and the emitters' of a quarter, as by default.
void measure_shadows(benchmark::State& state, GlContext& context, const Scene& scene) {
    Method method;
    const int size = static_cast<int>(state.range(0));
    ShadowSettings& shadow = method.direct.shadow;
    shadow.map_size = size, shadow.cube_size = size / 2, shadow.emitter_size = size / 4;
    Quantities quantities;
    quantities.planes = {"direct"};
    const View view(scene.camera("court"), 32, 18);
    Pipeline pipeline(context, scene, method, quantities, view.width(), view.height());
    pipeline.time_passes(view);
    double total = 0.0;
    for (auto _ : state) {
        const double seconds = seconds_of("shadows", pipeline, view, state);
        if (seconds < 0.0) return;
        state.SetIterationTime(seconds);
        total += seconds;
    }
    const auto squares = [&](std::size_t maps, int side) { return static_cast<double>(maps) * side * side; };
    const LightSet lights(scene, method.direct);
    const double texels = squares(lights.maps.size(), size) + squares(6 * lights.point_cubes.size(), shadow.cube_size) +
                          squares(6 * lights.emitter_cubes.size(), shadow.emitter_size);
    state.counters["texels"] = texels;
    state.counters["ns_per_texel"] = 1e9 * total / (static_cast<double>(state.iterations()) * texels);
}

// The environment's maps are made in a pipeline's first frame and kept, whatever the image's size.
void measure_environment_maps(benchmark::State& state, GlContext& context, const Scene& scene) {
    Method method;
    method.environment.size = static_cast<int>(state.range(0));
    method.reflections.enabled = true, method.reflections.fallback = ReflectionFallback::environment;
    Quantities quantities;
    quantities.planes = {"reflection"};
    const View view(scene.camera("court"), 32, 18);
    double total = 0.0;
    for (auto _ : state) {
        Pipeline pipeline(context, scene, method, quantities, view.width(), view.height());
        const double seconds = seconds_of("environment maps", pipeline, view, state);
        if (seconds < 0.0) return;
        state.SetIterationTime(seconds);
        total += seconds;
    }
    const double texels = 6.0 * static_cast<double>(state.range(0) * state.range(0));
    state.counters["texels"] = texels;
    state.counters["taps"] = texels * method.environment.samples;
    state.counters["ns_per_tap"] =
        1e9 * total / (static_cast<double>(state.iterations()) * texels * method.environment.samples);
}

}  // namespace
}  // namespace plumb

int main(int argument_count, char** arguments) {
    benchmark::Initialize(&argument_count, arguments);
    if (benchmark::ReportUnrecognizedArguments(argument_count, arguments)) return 2;
    const std::unique_ptr<plumb::GlContext> context = plumb::GlContext::create();
    const plumb::Scene scene = plumb::colonnade();
    std::printf("%s, %s\n", context->info().renderer.c_str(), context->info().platform.c_str());
    for (const plumb::PassCase& pass_case : plumb::pass_cases) {
        benchmark::RegisterBenchmark(
            pass_case.pass, [&](benchmark::State& state) { plumb::measure(state, *context, scene, pass_case); })
            ->Arg(180)
            ->Arg(360)
            ->Arg(720)
            ->ArgName("height")
            ->UseManualTime()
            ->Iterations(10)  // each is a frame; a time limit on a cheap pass would wait for its costly neighbours
            ->Unit(benchmark::kMillisecond);
    }
    benchmark::RegisterBenchmark("shadows",
                                 [&](benchmark::State& state) { plumb::measure_shadows(state, *context, scene); })
        ->Arg(512)
        ->Arg(1024)
        ->Arg(2048)
        ->ArgName("size")
        ->UseManualTime()
        ->Iterations(10)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(
        "environment maps", [&](benchmark::State& state) { plumb::measure_environment_maps(state, *context, scene); })
        ->Arg(64)
        ->Arg(128)
        ->Arg(256)
        ->ArgName("size")
        ->UseManualTime()
        ->Iterations(3)
        ->Unit(benchmark::kMillisecond);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}

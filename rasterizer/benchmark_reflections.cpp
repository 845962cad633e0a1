// What reflections cost over steps, layers and roughness, at three sizes: all of their passes together, as the pipeline
// measures them, on the Cornell box with every surface made glossy. `steps` is the most that all rays of all pixels may
// take; rays that end before are the reason why `ns_per_step` falls with max_steps.
#include <string>

#include <benchmark/benchmark.h>

#include "rasterizer/benchmark_context.h"
#include "rasterizer/pipeline.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

const Scene& scene() {
    static const Scene instance = [] {
        Scene glossy = make_cornell();
        for (Material& material : glossy.materials) material.dielectric_reflectance = 0.04f, material.roughness = 0.3f;
        return glossy;
    }();
    return instance;
}

// Arguments: height of the image, most steps, layers, ReflectionRoughness, rays where those are sampled.
void reflections(benchmark::State& state) {
    const auto height = static_cast<int>(state.range(0));
    Method method;
    method.ao.enabled = method.radiosity.enabled = false;
    ReflectionSettings& settings = method.reflections;
    settings.enabled = true;
    settings.max_steps = static_cast<int>(state.range(1));
    settings.layers = static_cast<int>(state.range(2));
    settings.roughness = static_cast<ReflectionRoughness>(state.range(3));
    settings.samples = static_cast<int>(state.range(4));
    const View view(scene().camera("front"), height * 16 / 9, height);
    Pipeline pipeline(benchmark_context(), scene(), method, {.planes = {"reflection"}}, view.width(), view.height());
    pipeline.time_passes(view);  // the driver compiles shaders at their first use
    double seconds = 0.0;
    for ([[maybe_unused]] auto _ : state) {
        double frame = 0.0;
        for (const PassTiming& timing : pipeline.time_passes(view)) {
            const bool counts =
                timing.pass == "reflections" || timing.pass == "radiance MIP chain" || timing.pass == "lamp highlights";
            if (counts) frame += timing.milliseconds / 1000.0;
        }
        state.SetIterationTime(frame);
        seconds += frame;
    }
    const double pixels = static_cast<double>(view.width()) * view.height();
    const double rays = settings.roughness == ReflectionRoughness::samples ? settings.samples : 1.0;
    const double steps = pixels * rays * settings.max_steps;
    state.counters["pixels"] = pixels;
    state.counters["steps"] = steps;
    state.counters["ns_per_step"] = 1e9 * seconds / (static_cast<double>(state.iterations()) * steps);
    state.SetLabel(benchmark_context().info().renderer);
}

void over_steps_layers_and_roughness(benchmark::internal::Benchmark* cases) {
    constexpr int mirror = static_cast<int>(ReflectionRoughness::mirror),
                  mip = static_cast<int>(ReflectionRoughness::mip),
                  samples = static_cast<int>(ReflectionRoughness::samples);
    cases->ArgNames({"height", "max_steps", "layers", "roughness", "rays"});
    for (const int height : {180, 360, 720}) {
        for (const int layers : {1, 2}) cases->Args({height, 512, layers, mip, 1});
    }
    for (const int steps : {16, 64, 256}) cases->Args({360, steps, 2, mirror, 1});
    cases->Args({360, 512, 2, mirror, 1});
    for (const int rays : {1, 4, 16}) cases->Args({360, 512, 2, samples, rays});
    cases->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
}

BENCHMARK(reflections)->Apply(over_steps_layers_and_roughness);

}  // namespace
}  // namespace plumb

BENCHMARK_MAIN();

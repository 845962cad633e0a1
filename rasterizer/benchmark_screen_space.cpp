// What the screen-space passes cost on a view of 1280x720: over taps, radius, layers, with and without the MIP chain.
// The time is that of the pass alone, as the pipeline measures it.
#include <string>

#include <benchmark/benchmark.h>

#include "rasterizer/benchmark_context.h"
#include "rasterizer/pipeline.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

const Scene& scene() {
    static const Scene instance = make_cornell();
    return instance;
}

void measure(benchmark::State& state, const Method& method, const Quantities& quantities, const std::string& pass) {
    const View view(scene().camera("front"), 1280, 720);
    Pipeline pipeline(benchmark_context(), scene(), method, quantities, view.width(), view.height());
    pipeline.time_passes(view);  // the driver compiles shaders at their first use
    for ([[maybe_unused]] auto _ : state) {
        for (const PassTiming& timing : pipeline.time_passes(view)) {
            if (timing.pass == pass) state.SetIterationTime(timing.milliseconds / 1000.0);
        }
    }
    state.SetLabel(benchmark_context().info().renderer);
}

// Arguments: taps, radius in centimetres, layers, MIP chain.
void ambient_obscurance(benchmark::State& state) {
    Method method;
    method.ao.samples = static_cast<int>(state.range(0));
    method.ao.layers = static_cast<int>(state.range(2));
    method.ao.use_mip_chain = state.range(3) != 0;
    measure(state, method, {.planes = {"ao"}, .ao_radius = static_cast<float>(state.range(1)) / 100.0f},
            "ambient obscurance");
}

void radiosity(benchmark::State& state) {
    Method method;
    method.radiosity.samples = static_cast<int>(state.range(0));
    method.radiosity.radius = static_cast<float>(state.range(1)) / 100.0f;
    method.radiosity.layers = static_cast<int>(state.range(2));
    method.radiosity.use_mip_chain = state.range(3) != 0;
    measure(state, method, {.planes = {"irradiance"}}, "radiosity");
}

// Argument: radius of the blur.
void ambient_obscurance_blur(benchmark::State& state) {
    Method method;
    method.ao.blur.radius = static_cast<int>(state.range(0));
    measure(state, method, {.planes = {"ao"}}, "ambient obscurance blur");
}

void radiosity_blur(benchmark::State& state) {
    Method method;
    method.radiosity.blur.radius = static_cast<int>(state.range(0));
    measure(state, method, {.planes = {"irradiance"}}, "radiosity blur");
}

// Of the first layer.
void depth_mip_chain(benchmark::State& state) { measure(state, {}, {.planes = {"ao"}}, "depth MIP chain"); }

void over_taps_and_radius(benchmark::internal::Benchmark* cases) {
    cases->ArgNames({"taps", "radius_cm", "layers", "mip"});
    for (const int layers : {1, 2}) {
        for (const int mip : {0, 1}) {
            for (const int taps : {8, 16, 32}) cases->Args({taps, 50, layers, mip});
            for (const int radius : {10, 200}) cases->Args({16, radius, layers, mip});
        }
    }
    cases->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
}

BENCHMARK(ambient_obscurance)->Apply(over_taps_and_radius);
BENCHMARK(radiosity)->Apply(over_taps_and_radius);
BENCHMARK(ambient_obscurance_blur)
    ->ArgName("radius")
    ->Arg(1)
    ->Arg(4)
    ->Arg(8)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);
BENCHMARK(radiosity_blur)->ArgName("radius")->Arg(4)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(depth_mip_chain)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);

}  // namespace
}  // namespace plumb

BENCHMARK_MAIN();

// What the screen-space passes cost over taps, radius, layers, with and without the MIP chain, at three sizes. The time
// is that of the pass alone, as the pipeline measures it. `taps` are texels that all pixels look at, each layer by
// itself; `ns_per_tap` is read over them.
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

// The first argument is the height of the image.
void measure(benchmark::State& state, const Method& method, const Quantities& quantities, const std::string& pass,
             double taps_per_pixel) {
    const int height = static_cast<int>(state.range(0)), width = height * 16 / 9;
    const View view(scene().camera("front"), width, height);
    Pipeline pipeline(benchmark_context(), scene(), method, quantities, width, height);
    pipeline.time_passes(view);  // the driver compiles shaders at their first use
    double seconds = 0.0;
    for ([[maybe_unused]] auto _ : state) {
        for (const PassTiming& timing : pipeline.time_passes(view)) {
            if (timing.pass != pass) continue;
            state.SetIterationTime(timing.milliseconds / 1000.0);
            seconds += timing.milliseconds / 1000.0;
        }
    }
    const double pixels = static_cast<double>(width) * height, taps = pixels * taps_per_pixel;
    state.counters["pixels"] = pixels;
    state.counters["taps"] = taps;
    state.counters["ns_per_tap"] = 1e9 * seconds / (static_cast<double>(state.iterations()) * taps);
    state.SetLabel(benchmark_context().info().renderer);
}

// Further arguments: taps, radius in centimetres, layers, MIP chain.
void ambient_obscurance(benchmark::State& state) {
    Method method;
    method.ao.samples = static_cast<int>(state.range(1));
    method.ao.layers = static_cast<int>(state.range(3));
    method.ao.use_mip_chain = state.range(4) != 0;
    measure(state, method, {.planes = {"ao"}, .ao_radius = static_cast<float>(state.range(2)) / 100.0f},
            "ambient obscurance", static_cast<double>(method.ao.samples) * method.ao.layers);
}

void radiosity(benchmark::State& state) {
    Method method;
    method.radiosity.samples = static_cast<int>(state.range(1));
    method.radiosity.radius = static_cast<float>(state.range(2)) / 100.0f;
    method.radiosity.layers = static_cast<int>(state.range(3));
    method.radiosity.use_mip_chain = state.range(4) != 0;
    measure(state, method, {.planes = {"irradiance"}}, "radiosity",
            static_cast<double>(method.radiosity.samples) * method.radiosity.layers);
}

double taps_of(const BilateralBlurSettings& blur) { return 2.0 * (2 * blur.radius + 1); }

// Further argument: radius of the blur.
void ambient_obscurance_blur(benchmark::State& state) {
    Method method;
    method.ao.blur.radius = static_cast<int>(state.range(1));
    measure(state, method, {.planes = {"ao"}}, "ambient obscurance blur", taps_of(method.ao.blur));
}

void radiosity_blur(benchmark::State& state) {
    Method method;
    method.radiosity.blur.radius = static_cast<int>(state.range(1));
    measure(state, method, {.planes = {"irradiance"}}, "radiosity blur", taps_of(method.radiosity.blur));
}

// Of the first layer: a copy of level 0, and a quarter as many texels at each coarser one.
void depth_mip_chain(benchmark::State& state) { measure(state, {}, {.planes = {"ao"}}, "depth MIP chain", 4.0 / 3.0); }

void over_taps_and_radius(benchmark::internal::Benchmark* cases) {
    cases->ArgNames({"height", "taps", "radius_cm", "layers", "mip"});
    for (const int layers : {1, 2}) {
        for (const int mip : {0, 1}) {
            for (const int height : {180, 360, 720}) cases->Args({height, 16, 50, layers, mip});
            for (const int taps : {8, 32}) cases->Args({720, taps, 50, layers, mip});
            for (const int radius : {10, 200}) cases->Args({720, 16, radius, layers, mip});
        }
    }
    cases->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
}

void over_blur_radius(benchmark::internal::Benchmark* cases) {
    cases->ArgNames({"height", "radius"})->ArgsProduct({{180, 360, 720}, {1, 4, 8}});
    cases->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
}

BENCHMARK(ambient_obscurance)->Apply(over_taps_and_radius);
BENCHMARK(radiosity)->Apply(over_taps_and_radius);
BENCHMARK(ambient_obscurance_blur)->Apply(over_blur_radius);
BENCHMARK(radiosity_blur)->Apply(over_blur_radius);
BENCHMARK(depth_mip_chain)
    ->ArgName("height")
    ->Arg(180)
    ->Arg(360)
    ->Arg(720)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);

}  // namespace
}  // namespace plumb

BENCHMARK_MAIN();

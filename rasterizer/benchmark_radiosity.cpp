// What radiosity costs over taps, layers, bounces and the estimator, at three sizes: all of its passes together, as the
// pipeline measures them, on the Cornell box. `taps` are those of all pixels, layers and bounces; `ns_per_tap` is read
// over them.
#include <algorithm>
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

bool belongs_to_radiosity(const std::string& pass) {
    return pass.starts_with("radiosity") || pass.find("indirect.") != std::string::npos;
}

void measure(benchmark::State& state, const Method& method, int height) {
    const View view(scene().camera("front"), height * 16 / 9, height);
    Pipeline pipeline(benchmark_context(), scene(), method, {.planes = {"indirect"}}, view.width(), view.height());
    pipeline.time_passes(view);  // the driver compiles shaders at their first use
    double seconds = 0.0;
    for ([[maybe_unused]] auto _ : state) {
        double frame = 0.0;
        for (const PassTiming& timing : pipeline.time_passes(view)) {
            if (belongs_to_radiosity(timing.pass)) frame += timing.milliseconds / 1000.0;
        }
        state.SetIterationTime(frame);
        seconds += frame;
    }
    const RadiositySettings& settings = method.radiosity;
    const double pixels = static_cast<double>(view.width()) * view.height();
    const int gatherings =
        settings.second_layer == SecondLayerIndirect::gather
            ? settings.layers * (settings.carry ? 1 : settings.bounces - 1) + (settings.carry ? 0 : 1)
            : settings.bounces;
    const double taps = pixels * settings.samples * settings.layers * gatherings;
    state.counters["pixels"] = pixels;
    state.counters["taps"] = taps;
    state.counters["ns_per_tap"] = 1e9 * seconds / (static_cast<double>(state.iterations()) * taps);
    state.counters["GL_MiB"] = static_cast<double>(benchmark_context().allocated_bytes()) / (1024.0 * 1024.0);
    state.SetLabel(benchmark_context().info().renderer);
}

Method method_of(benchmark::State& state) {
    Method method;
    method.radiosity.samples = static_cast<int>(state.range(1));
    method.radiosity.layers = static_cast<int>(state.range(2));
    method.radiosity.radius = 0.3f;
    return method;
}

void bounces(benchmark::State& state) {
    Method method = method_of(state);
    method.radiosity.bounces = static_cast<int>(state.range(3));
    measure(state, method, static_cast<int>(state.range(0)));
}

void bounces_gathered_for_both_layers(benchmark::State& state) {
    Method method = method_of(state);
    method.radiosity.bounces = static_cast<int>(state.range(3));
    method.radiosity.second_layer = SecondLayerIndirect::gather;
    measure(state, method, static_cast<int>(state.range(0)));
}

void bounces_of_nielsen(benchmark::State& state) {
    Method method = method_of(state);
    method.radiosity.estimator = RadiosityEstimator::nielsen2015;
    method.radiosity.test_tap_normal = false;
    method.radiosity.bounces = static_cast<int>(state.range(3));
    measure(state, method, static_cast<int>(state.range(0)));
}

void carried(benchmark::State& state) {
    Method method = method_of(state);
    method.radiosity.carry = true;
    measure(state, method, static_cast<int>(state.range(0)));
}

void over_taps_layers_and_bounces(benchmark::internal::Benchmark* cases) {
    cases->ArgNames({"height", "taps", "layers", "bounces"});
    for (const int layers : {1, 2}) {
        for (const int count : {1, 2, 5}) {
            for (const int taps : {11, 23}) cases->Args({360, taps, layers, count});
        }
    }
    for (const int height : {180, 720}) cases->Args({height, 23, 2, 2});
    cases->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
}

void over_bounces(benchmark::internal::Benchmark* cases) {
    cases->ArgNames({"height", "taps", "layers", "bounces"});
    for (const int count : {2, 5}) cases->Args({360, 23, 2, count});
    for (const int height : {180, 720}) cases->Args({height, 23, 2, 2});
    cases->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
}

void over_sizes(benchmark::internal::Benchmark* cases) {
    cases->ArgNames({"height", "taps", "layers"});
    for (const int height : {180, 360, 720}) cases->Args({height, 23, 2});
    cases->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
}

BENCHMARK(bounces)->Apply(over_taps_layers_and_bounces);
BENCHMARK(bounces_gathered_for_both_layers)->Apply(over_bounces);
BENCHMARK(bounces_of_nielsen)->Apply(over_bounces);
BENCHMARK(carried)->Apply(over_sizes);

}  // namespace
}  // namespace plumb

BENCHMARK_MAIN();

// What blurs, temporal filters and temporal anti-aliasing cost at three sizes. The time is that of the pass alone, as
// the pipeline measures it, in a still view whose history is full; counted are pixels, and texels of the filtered plane
// that are read.
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

// The first argument is the number of rows.
void measure(benchmark::State& state, const Method& method, const std::string& plane, const std::string& pass,
             double taps_per_pixel) {
    const int height = static_cast<int>(state.range(0)), width = height * 16 / 9;
    const View view(scene().camera("front"), width, height);
    Pipeline pipeline(benchmark_context(), scene(), method, {.planes = {plane}}, width, height);
    // The driver compiles shaders at their first use, and the second frame is the first with a history.
    for (int i = 0; i < 2; ++i) pipeline.time_passes(view);
    double seconds = 0.0;
    for ([[maybe_unused]] auto _ : state) {
        for (const PassTiming& timing : pipeline.time_passes(view)) {
            if (timing.pass != pass) continue;
            state.SetIterationTime(timing.milliseconds / 1000.0);
            seconds += timing.milliseconds / 1000.0;
        }
    }
    const double pixels = static_cast<double>(width) * height;
    state.counters["pixels"] = pixels;
    state.counters["taps"] = pixels * taps_per_pixel;
    state.counters["ns_per_tap"] = 1e9 * seconds / (static_cast<double>(state.iterations()) * pixels * taps_per_pixel);
    state.SetLabel(benchmark_context().info().renderer);
}

// The second argument: the kind.
void ambient_obscurance_blur(benchmark::State& state) {
    Method method;
    method.ao.blur.kind = static_cast<BlurKind>(state.range(1));
    measure(state, method, "ao", "ambient obscurance blur", 2.0 * (2 * method.ao.blur.radius + 1));
}

void radiosity_blur(benchmark::State& state) {
    Method method;
    method.radiosity.blur.kind = static_cast<BlurKind>(state.range(1));
    measure(state, method, "irradiance", "radiosity blur", 2.0 * (2 * method.radiosity.blur.radius + 1));
}

// The second argument: layers of the frame before. Four texels of history and one of this frame.
void ambient_obscurance_over_time(benchmark::State& state) {
    Method method;
    method.ao.temporal = {.alpha = 0.85f, .layers = static_cast<int>(state.range(1))};
    measure(state, method, "ao", "ambient obscurance over time", 5.0);
}

void radiosity_over_time(benchmark::State& state) {
    Method method;
    method.radiosity.temporal = {.alpha = 0.85f, .layers = static_cast<int>(state.range(1))};
    measure(state, method, "irradiance", "radiosity over time", 5.0);
}

// The second argument: the lookup, of 4 texels or 16, besides the nine of the clamp.
void temporal_antialias(benchmark::State& state) {
    Method method;
    method.antialias = {.temporal = true, .lookup = static_cast<HistoryLookup>(state.range(1))};
    measure(state, method, "total", "temporal antialias", state.range(1) == 0 ? 13.0 : 25.0);
}

template <int variants>
void at_three_sizes(benchmark::internal::Benchmark* cases) {
    for (const int rows : {360, 720, 1080}) {
        for (int variant = 0; variant < variants; ++variant) cases->Args({rows, variant});
    }
    cases->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(5);
}

void one_and_two_layers(benchmark::internal::Benchmark* cases) {
    cases->ArgNames({"rows", "layers"})->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(5);
    for (const int rows : {360, 720, 1080}) {
        for (const int layers : {1, 2}) cases->Args({rows, layers});
    }
}

BENCHMARK(ambient_obscurance_blur)->ArgNames({"rows", "kind"})->Apply(at_three_sizes<3>);
BENCHMARK(radiosity_blur)->ArgNames({"rows", "kind"})->Apply(at_three_sizes<3>);
BENCHMARK(ambient_obscurance_over_time)->Apply(one_and_two_layers);
BENCHMARK(radiosity_over_time)->Apply(one_and_two_layers);
BENCHMARK(temporal_antialias)->ArgNames({"rows", "lookup"})->Apply(at_three_sizes<2>);

}  // namespace
}  // namespace plumb

BENCHMARK_MAIN();

#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "pathtracer/benchmark_rays.h"
#include "pathtracer/benchmark_scene.h"
#include "pathtracer/ray_recorder.h"

namespace plumb {
namespace {

enum class Asks { nearest, any };

struct TraceCase {
    const char* name;
    RenderCase rendered;  // whose rays they are
    Asks asks;
    RayCoherence coherence = RayCoherence::incoherent;
};

void trace(benchmark::State& state, const std::shared_ptr<BenchmarkScene>& with, const TraceCase& asked,
           BareTrace bare) {
    RayRecorder recorder;
    with->tracer.set_recorder(&recorder);
    with->tracer.render(with->view(), asked.rendered.settings());
    with->tracer.set_recorder(nullptr);
    const std::vector<RecordedRay>& rays = asked.asks == Asks::nearest ? recorder.nearest() : recorder.any();
    for (auto _ : state) bare(with->traced.embree_scene(), rays, asked.coherence);
    state.counters["rays/s"] =
        benchmark::Counter(static_cast<double>(rays.size()), benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

void add_packet_benchmarks(const std::string& name, const std::shared_ptr<BenchmarkScene>& scene) {
    // Spread over the pixels, as those through their centres are found once.
    const RenderCase primary{"primary rays", {"emission"}, 1, true};
    const std::vector<TraceCase> cases = {
        {"primary rays", primary, Asks::nearest},
        {"primary rays, told to be coherent", primary, Asks::nearest, RayCoherence::coherent},
        {"bounces", path_case(), Asks::nearest},
        {"shadow rays", path_case(), Asks::any},
        {"ao", visibility_case(), Asks::any}};
    for (const TraceCase& asked : cases) {
        for (const WayToTrace& way : ways_to_trace()) {
            const BareTrace bare = asked.asks == Asks::nearest ? way.nearest : way.any;
            benchmark::RegisterBenchmark(fmt::format("packets/{}/{}, {}", name, asked.name, way.name).c_str(), trace,
                                         scene, asked, bare)
                ->Unit(benchmark::kMillisecond)
                ->UseRealTime();
        }
    }
}

}  // namespace plumb

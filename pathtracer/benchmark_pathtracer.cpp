// How fast references are rendered: rays and samples per second of each quantity on the built-in scenes, and the time
// to build a scene's tree. Run with --benchmark_filter=cornell and the like; the number of threads is the machine's.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "pathtracer/reference.h"
#include "scenes/builtin.h"

namespace {

struct BenchmarkCase {
    std::string name;
    std::vector<std::string> planes;
    int bounces;
    bool antialias;
};

void render(benchmark::State& state, const std::string& scene_name, const BenchmarkCase& asked) {
    const plumb::Scene scene = plumb::make_builtin_scene(scene_name);
    const plumb::PathTracer tracer(scene);
    const plumb::View view(scene.cameras.front(), 512, 512);
    plumb::ReferenceSettings settings;
    settings.quantities.planes = asked.planes;
    settings.quantities.bounces = asked.bounces;
    settings.antialias = asked.antialias;
    settings.samples = 8;
    double rays = 0.0, samples = 0.0;
    for (auto _ : state) {
        const plumb::ReferenceResult result = tracer.render(view, settings);
        rays += static_cast<double>(result.rays);
        samples += static_cast<double>(result.samples) * view.width() * view.height();
    }
    state.counters["rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
    state.counters["samples/s"] = benchmark::Counter(samples, benchmark::Counter::kIsRate);
}

void build(benchmark::State& state, const std::string& scene_name) {
    const plumb::Scene scene = plumb::make_builtin_scene(scene_name);
    for (auto _ : state) {
        const plumb::PathTracer tracer(scene);
        benchmark::DoNotOptimize(&tracer);
    }
    state.counters["triangles"] = static_cast<double>(scene.triangle_count());
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<BenchmarkCase> cases = {{"ao", {"ao"}, 1, false},
                                              {"direct", {"direct"}, 1, false},
                                              {"indirect.1", {"indirect.1"}, 1, false},
                                              {"total, 3 bounces", {"total"}, 3, false},
                                              {"total, 8 bounces, anti-aliased", {"total"}, 8, true}};
    for (const std::string& scene : plumb::builtin_scene_names()) {
        benchmark::RegisterBenchmark(fmt::format("build/{}", scene).c_str(), build, scene)
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime();
        for (const BenchmarkCase& asked : cases) {
            benchmark::RegisterBenchmark(fmt::format("render/{}/{}", scene, asked.name).c_str(), render, scene, asked)
                ->Unit(benchmark::kMillisecond)
                ->UseRealTime();
        }
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

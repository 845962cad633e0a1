// How fast references are rendered, beside what Embree alone does with the very same rays.
//
// Each case renders a view and records the rays of its samples; then, turn by turn, it renders again, from the first
// ray to the finished planes, and traces the recorded rays with bare calls on as many threads: single rays for paths,
// packets of sixteen for the ambient visibility. `ratio` is the time of the second over that of the first, from
// medians: the share that Embree alone would need. (Rays through the pixels' centres, which are found once, are not
// recorded: their time is ours alone.) benchmark_packets.cpp adds cases of bare calls alone.
//   bench_pathtracer [--scene NAME]... [Google Benchmark's options]
// Without --scene: the built-in scenes. Others are found in PLUMBLINE_SCENES.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "pathtracer/benchmark_rays.h"
#include "pathtracer/benchmark_scene.h"
#include "pathtracer/ray_recorder.h"
#include "scenes/builtin.h"
#include "scenes/scene_file.h"

namespace plumb {
namespace {

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

void render(benchmark::State& state, const std::shared_ptr<BenchmarkScene>& with, const RenderCase& asked) {
    const ReferenceSettings settings = asked.settings();
    const View view = with->view();
    RayRecorder recorder;
    with->tracer.set_recorder(&recorder);
    with->tracer.render(view, settings);
    with->tracer.set_recorder(nullptr);
    const double recorded = static_cast<double>(recorder.nearest().size() + recorder.any().size());
    const bool only_any = recorder.nearest().empty();

    std::vector<double> ours, bare;
    for (auto _ : state) {
        ours.push_back(seconds_of([&] { with->tracer.render(view, settings); }));
        bare.push_back(seconds_of([&] {
            singly.nearest(with->traced.embree_scene(), recorder.nearest(), RayCoherence::incoherent);
            (only_any ? by_sixteen : singly).any(with->traced.embree_scene(), recorder.any(), RayCoherence::incoherent);
        }));
        state.SetIterationTime(ours.back());
    }
    const double our_rate = recorded / median(ours), bare_rate = recorded / median(bare);
    state.counters["Mrays/s"] = our_rate * 1e-6;
    state.counters["bare Mrays/s"] = bare_rate * 1e-6;
    state.counters["ratio"] = our_rate / bare_rate;
    state.counters["Msamples/s"] = asked.samples * benchmark_view_size * benchmark_view_size / median(ours) * 1e-6;
}

void build(benchmark::State& state, const std::shared_ptr<BenchmarkScene>& with) {
    for (auto _ : state) {
        const PathTracer tracer(with->scene);
        benchmark::DoNotOptimize(&tracer);
    }
    state.counters["triangles"] = static_cast<double>(with->scene.triangle_count());
}

void add_benchmarks(const std::string& name) {
    const char* folder = std::getenv("PLUMBLINE_SCENES");
    std::vector<std::filesystem::path> folders;
    if (folder) folders.emplace_back(folder);
    const auto with = std::make_shared<BenchmarkScene>(load_scene(name, folders));
    // What production path tracers do by default: rays per sample fall, samples per second rise.
    const RenderCase roulette{
        "paths, 8 bounces, anti-aliased, roulette after 1", {"total"}, 8, true, Falloff::quadratic, 1};
    const std::vector<RenderCase> cases = {visibility_case(),
                                           {"ao, quadratic", {"ao"}, 1, false, Falloff::quadratic, 0, 256},
                                           {"direct", {"direct"}},
                                           {"indirect.1", {"indirect.1"}},
                                           {"ao, direct, indirect of 3 bounces", {"ao", "direct", "indirect"}, 3},
                                           path_case(),
                                           roulette};
    for (const RenderCase& asked : cases) {
        benchmark::RegisterBenchmark(fmt::format("render/{}/{}", name, asked.name).c_str(), render, with, asked)
            ->Unit(benchmark::kMillisecond)
            ->Iterations(5)
            ->UseManualTime();
    }
    add_packet_benchmarks(name, with);
    benchmark::RegisterBenchmark(fmt::format("build/{}", name).c_str(), build, with)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
}

}  // namespace
}  // namespace plumb

int main(int argc, char** argv) {
    std::vector<std::string> scenes;
    for (int i = 1; i + 1 < argc;) {
        if (std::string_view(argv[i]) != "--scene") {
            ++i;
            continue;
        }
        scenes.emplace_back(argv[i + 1]);
        std::rotate(argv + i, argv + i + 2, argv + argc);
        argc -= 2;
    }
    if (scenes.empty()) scenes = plumb::builtin_scene_names();
    try {
        for (const std::string& scene : scenes) plumb::add_benchmarks(scene);
    } catch (const std::exception& error) {
        fmt::print(stderr, "bench_pathtracer: {}\n", error.what());
        return 2;
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

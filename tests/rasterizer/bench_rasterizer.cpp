// Milliseconds of each pass at three sizes, on the colonnade: `bench_rasterizer --benchmark_filter=direct`.
//
// Only the passes that the measured one needs run with it. Times are the pipeline's own (GPU timer queries, or glFinish
// and the steady clock on a software rasteriser), without read-back.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "rasterizer/gl_context.h"
#include "rasterizer/pipeline.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

struct PassCase {
    const char* pass;
    std::vector<std::string> planes;  // what to ask for, so that the pass runs
};

const std::vector<PassCase> pass_cases{{"gbuffer", {"depth", "normal", "albedo"}},
                                       {"gbuffer.layer2", {"layer2.depth", "layer2.normal", "layer2.albedo"}},
                                       {"motion", {"motion"}},
                                       {"depth MIP chain", {"ao"}},
                                       {"ambient obscurance", {"ao"}},
                                       {"ambient obscurance blur", {"ao"}},
                                       {"shadows", {"direct"}},
                                       {"direct", {"direct"}},
                                       {"direct.layer2", {"layer2.direct"}},
                                       {"radiosity", {"indirect"}},
                                       {"radiosity blur", {"indirect"}},
                                       {"radiosity reflection", {"indirect"}},
                                       {"composite", {"total"}}};

void measure(benchmark::State& state, GlContext& context, const Scene& scene, const PassCase& pass_case) {
    const int height = static_cast<int>(state.range(0)), width = height * 16 / 9;
    Quantities quantities;
    quantities.planes = pass_case.planes;
    Pipeline pipeline(context, scene, Method(), quantities, width, height);
    const View view(scene.camera("court"), width, height);
    pipeline.time_passes(view);  // the first frame compiles what drivers compile late
    for (auto _ : state) {
        const std::vector<PassTiming> timings = pipeline.time_passes(view);
        const auto timing = std::ranges::find(timings, pass_case.pass, &PassTiming::pass);
        if (timing == timings.end()) {
            state.SkipWithError("the pass did not run");
            return;
        }
        state.SetIterationTime(1e-3 * timing->milliseconds);
    }
    state.counters["pixels"] = static_cast<double>(width) * height;
    state.counters["GL_MiB"] = static_cast<double>(context.allocated_bytes()) / (1024.0 * 1024.0);
}

}  // namespace
}  // namespace plumb

int main(int argument_count, char** arguments) {
    benchmark::Initialize(&argument_count, arguments);
    if (benchmark::ReportUnrecognizedArguments(argument_count, arguments)) return 2;
    const std::unique_ptr<plumb::GlContext> context = plumb::GlContext::create();
    const plumb::Scene scene = plumb::make_builtin_scene("colonnade");
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
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}

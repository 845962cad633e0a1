// How long the measures take on one full-HD frame of three channels.
//
//   build/release/bin/bench_metrics
#include <random>

#include <benchmark/benchmark.h>

#include "metrics/comparison.h"
#include "metrics/flip.h"

namespace plumb {
namespace {

Image noisy(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform;
    Image image(1920, 1080, 3);
    for (float& value : image.values()) value = uniform(random);
    return image;
}

const Image& test_image() {
    static const Image image = noisy(1);
    return image;
}
const Image& reference_image() {
    static const Image image = noisy(2);
    return image;
}

void run_ssim(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(ssim(test_image(), reference_image(), 1.0).mean);
}
void run_multi_scale_ssim(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(multi_scale_ssim(test_image(), reference_image(), 1.0));
}
void run_pixel_errors(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(pixel_errors(test_image(), reference_image(), 1.0).mse);
}
void run_referenced_error(benchmark::State& state) {
    static const Image half = noisy(3);
    for (auto _ : state) {
        benchmark::DoNotOptimize(referenced_error(test_image(), reference_image(), half, 64).mse);
    }
}

void run_ldr_flip(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(mean_flip(ldr_flip(test_image(), reference_image())));
}
// At two exposures; each further one costs half of this.
void run_hdr_flip(benchmark::State& state) {
    for (auto _ : state) {
        benchmark::DoNotOptimize(mean_flip(hdr_flip(test_image(), reference_image(), {-1.0, 1.0, 2})));
    }
}

// What a row of results takes: every measure, with or without the intervals; FLIP apart.
void run_all_measures(benchmark::State& state) {
    ComparisonSettings settings;
    settings.intervals = state.range(0) != 0;
    for (auto _ : state) benchmark::DoNotOptimize(compare_planes(test_image(), reference_image(), settings).errors.mse);
}

BENCHMARK(run_all_measures)
    ->Name("all but FLIP, 1920x1080x3")
    ->ArgName("intervals")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(run_ldr_flip)->Name("LDR-FLIP, 1920x1080x3")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(run_hdr_flip)->Name("HDR-FLIP, 1920x1080x3")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(run_ssim)->Name("ssim, 1920x1080x3")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(run_multi_scale_ssim)->Name("multi-scale SSIM, 1920x1080x3")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(run_pixel_errors)->Name("pixel errors, 1920x1080x3")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(run_referenced_error)->Name("referenced error, 1920x1080x3")->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace plumb

BENCHMARK_MAIN();

// Milliseconds of what lights: full-screen shading against light volumes with and without the stencil over the number
// of lights, the kinds of shadow maps, their filter, the environment's maps and the probe, each at three sizes:
// `bench_lights --benchmark_filter=local_lights`.
//
// `shaded` counts how often a light was evaluated, per frame; `pixels` those with a surface or the texels drawn; `taps`
// comparisons or samples of all of these. `ns_per_shaded`, `ns_per_tap` and, of what is drawn and not looked up,
// `ns_per_texel` are read over them. Times are wall time between two glFinish.
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "light_run.h"
#include "many_lamps.h"
#include "rasterizer/gl_context.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

GlContext& context() {
    static const std::unique_ptr<GlContext> instance = GlContext::create(GlBackend::automatic, false);
    return *instance;
}

Method lamp_method() {
    Method method;
    method.ao.enabled = method.radiosity.enabled = false;
    return method;
}

View view_of(const Scene& scene, int height) { return View(scene.cameras.front(), height * 16 / 9, height); }

std::uint64_t count_surfaces(const LightRun& run) {
    std::uint64_t count = 0;
    const Image depths = run.image("depth", 1);
    for (const float depth : depths.values()) count += std::isinf(depth) ? 0 : 1;
    return count;
}

// Returns the mean of the nanoseconds.
template <typename Action>
double time(benchmark::State& state, const Action& action) {
    const GladGLContext& gl = context().gl;
    action();  // the driver compiles shaders at their first use
    double sum = 0.0;
    for ([[maybe_unused]] auto _ : state) {
        gl.Finish();
        const auto start = std::chrono::steady_clock::now();
        action();
        gl.Finish();
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        state.SetIterationTime(seconds);
        sum += seconds;
    }
    return 1e9 * sum / static_cast<double>(state.iterations());
}

void count_taps(benchmark::State& state, double pixels, double taps_per_pixel, double nanoseconds) {
    state.counters["pixels"] = pixels;
    state.counters["taps"] = pixels * taps_per_pixel;
    state.counters["ns_per_tap"] = nanoseconds / (pixels * taps_per_pixel);
}

// Of maps that are drawn, with 32-bit depths.
void count_texels(benchmark::State& state, const Scene& scene, double texels, double nanoseconds) {
    state.counters["pixels"] = texels;
    state.counters["ns_per_texel"] = nanoseconds / texels;
    state.counters["triangles"] = static_cast<double>(scene.triangle_count());
    state.counters["MiB"] = 4.0 * texels / (1024.0 * 1024.0);
}

void local_lights(benchmark::State& state, LocalLights local_lights) {
    Scene scene = make_colonnade();
    scene.point_lights.clear(), scene.spot_lights.clear(), scene.directional_lights.clear();
    scene.environment = {};
    add_lamps(scene, static_cast<int>(state.range(0)));
    Method method = lamp_method();
    method.direct.local_lights = local_lights;
    method.direct.shadow.lamps = false;
    const View view = view_of(scene, static_cast<int>(state.range(1)));
    LightRun timed(context(), scene, method, {"direct"}, view, false);
    timed.run();
    const std::uint64_t surfaces = count_surfaces(timed);
    const bool volumes = local_lights != LocalLights::fullscreen;
    const double nanoseconds = time(state, [&] {
        if (volumes) timed.run("light volumes");
        timed.run("direct");
    });
    std::uint64_t shaded = surfaces * static_cast<std::uint64_t>(state.range(0));
    if (volumes) {
        LightRun counted(context(), scene, method, {"direct"}, view, true);
        counted.run();
        shaded = counted.fragments_shaded();
    }
    state.counters["pixels"] = static_cast<double>(surfaces);
    state.counters["shaded"] = static_cast<double>(shaded);
    state.counters["shaded_per_pixel"] = static_cast<double>(shaded) / static_cast<double>(surfaces);
    // A small volume may shade nothing at all.
    if (shaded > 0) state.counters["ns_per_shaded"] = nanoseconds / static_cast<double>(shaded);
}

void over_lights(benchmark::internal::Benchmark* cases) {
    cases->ArgNames({"lights", "height"})->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
    for (const int height : {90, 180, 360}) {
        for (const int lights : {1, 16, 256, 1024}) cases->Args({lights, height});
    }
}

void point_shadows(benchmark::State& state, const ShadowSettings& settings) {
    Scene scene = make_colonnade();
    scene.point_lights.clear(), scene.directional_lights.clear(), scene.environment = {};
    scene.point_lights.push_back({"lamp", scene.bounds().centre(), glm::vec3(100.0f)});
    Method method = lamp_method();
    method.direct.shadow = settings;
    const int size = static_cast<int>(state.range(0));
    method.direct.shadow.cube_size = method.direct.shadow.paraboloid_size = size;
    LightRun run(context(), scene, method, {"direct"}, view_of(scene, 90));
    run.run();
    const double nanoseconds = time(state, [&] { run.run("shadows"); });
    const int squares = settings.point_map == PointShadowMap::cube ? 6 : 2;
    count_texels(state, scene, static_cast<double>(squares) * size * size, nanoseconds);
}

enum class FlatMap { sun, spot };

void flat_shadows(benchmark::State& state, FlatMap kind) {
    Scene scene = make_colonnade();
    scene.point_lights.clear(), scene.environment = {};
    if (kind == FlatMap::spot) {
        scene.directional_lights.clear();
        scene.spot_lights.push_back(
            {"spot", scene.bounds().centre(), glm::vec3(0.0f, -1.0f, 0.0f), glm::vec3(100.0f), 0.4f, 0.8f});
    }
    Method method = lamp_method();
    const int size = method.direct.shadow.map_size = static_cast<int>(state.range(0));
    LightRun run(context(), scene, method, {"direct"}, view_of(scene, 90));
    run.run();
    const double nanoseconds = time(state, [&] { run.run("shadows"); });
    count_texels(state, scene, static_cast<double>(size) * size, nanoseconds);
}

// The cubes of the box's one lamp, seen from so many of its points.
void emitter_shadows(benchmark::State& state, int points) {
    const Scene scene = make_cornell();
    Method method = lamp_method();
    method.direct.shadow.emitter_samples = points;
    const int size = method.direct.shadow.emitter_size = static_cast<int>(state.range(0));
    LightRun run(context(), scene, method, {"direct"}, view_of(scene, 90));
    run.run();
    const double nanoseconds = time(state, [&] { run.run("shadows"); });
    count_texels(state, scene, 6.0 * points * size * size, nanoseconds);
}

// Of the whole direct light under a sun; its shadow lookups are the difference between radii.
void shadow_filter(benchmark::State& state) {
    const Scene scene = make_colonnade();
    Method method = lamp_method();
    method.direct.shadow.pcf_radius = static_cast<int>(state.range(0));
    method.direct.shadow.map_size = static_cast<int>(state.range(2));
    LightRun run(context(), scene, method, {"direct"}, view_of(scene, static_cast<int>(state.range(1))));
    run.run();
    const double nanoseconds = time(state, [&] { run.run("direct"); });
    const double taps = static_cast<double>((2 * state.range(0) + 1) * (2 * state.range(0) + 1));
    count_taps(state, static_cast<double>(count_surfaces(run)),
               taps * static_cast<double>(scene.directional_lights.size()), nanoseconds);
}

void environment_maps(benchmark::State& state) {
    const Scene scene = make_colonnade();
    Method method = lamp_method();
    method.environment.size = static_cast<int>(state.range(0));
    LightRun run(context(), scene, method, RadianceMaps::outputs("environment"), view_of(scene, 90));
    auto& pass = dynamic_cast<EnvironmentMapsPass&>(run.pass("environment maps"));
    const double nanoseconds = time(state, [&] { pass.make(); });
    count_taps(state, 6.0 * static_cast<double>(state.range(0) * state.range(0)), method.environment.samples,
               nanoseconds);
}

void probe(benchmark::State& state) {
    const Scene scene = make_colonnade();
    Method method = lamp_method();
    const glm::vec3 centre = scene.bounds().centre();
    method.probe = {centre.x, centre.y, centre.z, static_cast<int>(state.range(0)), true};
    LightRun run(context(), scene, method, RadianceMaps::outputs("probe"), view_of(scene, 90));
    const double nanoseconds = time(state, [&] { run.run("probe"); });
    count_taps(state, 6.0 * static_cast<double>(state.range(0) * state.range(0)), method.environment.samples,
               nanoseconds);
}

void three_sizes(benchmark::internal::Benchmark* cases, const std::vector<std::int64_t>& sizes) {
    cases->ArgName("size")->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
    for (const std::int64_t size : sizes) cases->Arg(size);
}

}  // namespace
}  // namespace plumb

int main(int argument_count, char** arguments) {
    using namespace plumb;
    benchmark::Initialize(&argument_count, arguments);
    if (benchmark::ReportUnrecognizedArguments(argument_count, arguments)) return 2;
    std::printf("%s, %s\n", context().info().renderer.c_str(), context().info().platform.c_str());
    for (const auto& [name, value] :
         {std::pair{"fullscreen", LocalLights::fullscreen}, std::pair{"volume", LocalLights::volume},
          std::pair{"volume_stencil", LocalLights::volume_stencil}}) {
        over_lights(
            benchmark::RegisterBenchmark(fmt::format("local_lights/{}", name).c_str(),
                                         [value = value](benchmark::State& state) { local_lights(state, value); }));
    }
    ShadowSettings one_pass, linear, paraboloid;
    one_pass.cube_generation = linear.cube_generation = CubeGeneration::one_pass;
    linear.cube_distance = CubeDistance::linear;
    paraboloid.point_map = PointShadowMap::dual_paraboloid;
    ShadowSettings uncut = paraboloid, coarse = paraboloid;
    uncut.paraboloid_tessellation = 1, coarse.paraboloid_tessellation = 8;
    for (const auto& [name, settings] : {std::pair{"six_views", ShadowSettings()}, std::pair{"one_pass", one_pass},
                                         std::pair{"one_pass_linear", linear}, std::pair{"paraboloid_1", uncut},
                                         std::pair{"paraboloid_8", coarse}, std::pair{"paraboloid_64", paraboloid}}) {
        three_sizes(benchmark::RegisterBenchmark(
                        fmt::format("point_shadows/{}", name).c_str(),
                        [settings = settings](benchmark::State& state) { point_shadows(state, settings); }),
                    {256, 512, 1024});
    }
    for (const auto& [name, kind] : {std::pair{"sun", FlatMap::sun}, std::pair{"spot", FlatMap::spot}}) {
        three_sizes(benchmark::RegisterBenchmark(fmt::format("flat_shadows/{}", name).c_str(),
                                                 [kind = kind](benchmark::State& state) { flat_shadows(state, kind); }),
                    {512, 1024, 2048});
    }
    for (const int points : {1, 4}) {
        three_sizes(benchmark::RegisterBenchmark(fmt::format("emitter_shadows/{}", points).c_str(),
                                                 [points](benchmark::State& state) { emitter_shadows(state, points); }),
                    {128, 256, 512});
    }
    benchmark::internal::Benchmark* filter = benchmark::RegisterBenchmark("shadow_filter", shadow_filter);
    filter->ArgNames({"radius", "height", "map"})->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
    for (const int radius : {0, 1, 3}) {
        for (const int height : {180, 360, 720}) filter->Args({radius, height, 2048});
        for (const int map : {512, 1024}) filter->Args({radius, 360, map});
    }
    three_sizes(benchmark::RegisterBenchmark("environment_maps", environment_maps), {64, 128, 256});
    three_sizes(benchmark::RegisterBenchmark("probe", probe), {32, 64, 128});
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}

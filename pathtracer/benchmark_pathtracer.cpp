// How fast references are rendered, beside what Embree alone does with the very same rays.
//
// Each case renders a view and records the rays of its samples; then, turn by turn, it renders again, from the first
// ray to the finished planes, and traces the recorded rays with bare calls on as many threads: single rays for paths,
// packets of sixteen for the ambient visibility. `ratio` is the time of the second over that of the first, from
// medians: the share that Embree alone would need. (Rays through the pixels' centres, which are found once, are not
// recorded: their time is ours alone.) Cases `packets/` trace the same rays in all ways that Embree has, which is what
// the path tracer's choice of calls rests on.
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
#include <tbb/parallel_for.h>

#include "pathtracer/ray_recorder.h"
#include "pathtracer/reference.h"
#include "pathtracer/traced_scene.h"
#include "scenes/builtin.h"
#include "scenes/scene_file.h"

namespace plumb {
namespace {

constexpr int view_size = 256;

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

// Calls `trace` with ranges of rays on all threads.
template <typename Trace>
void in_chunks(std::size_t count, const Trace& trace) {
    constexpr std::size_t chunk = 4096;
    tbb::parallel_for(std::size_t{0}, (count + chunk - 1) / chunk,
                      [&](std::size_t i) { trace(i * chunk, std::min(count, (i + 1) * chunk)); });
}

RTCRay single_ray(const RecordedRay& from) {
    RTCRay ray;
    ray.org_x = from.origin.x, ray.org_y = from.origin.y, ray.org_z = from.origin.z, ray.tnear = from.nearest;
    ray.dir_x = from.direction.x, ray.dir_y = from.direction.y, ray.dir_z = from.direction.z, ray.time = now;
    ray.tfar = from.farthest, ray.mask = 0xffffffffu, ray.id = 0, ray.flags = 0;
    return ray;
}

template <typename Packet>
void set_ray(Packet& packet, int i, const RecordedRay& from) {
    packet.org_x[i] = from.origin.x, packet.org_y[i] = from.origin.y, packet.org_z[i] = from.origin.z;
    packet.dir_x[i] = from.direction.x, packet.dir_y[i] = from.direction.y, packet.dir_z[i] = from.direction.z;
    packet.tnear[i] = from.nearest, packet.tfar[i] = from.farthest, packet.time[i] = now;
    packet.mask[i] = 0xffffffffu, packet.id[i] = 0, packet.flags[i] = 0;
}

void nearest_singly(RTCScene scene, const std::vector<RecordedRay>& rays) {
    in_chunks(rays.size(), [&](std::size_t begin, std::size_t end) {
        EmbreeQuery query(RayCoherence::incoherent);
        for (std::size_t i = begin; i < end; ++i) {
            RTCRayHit ray{single_ray(rays[i]), {}};
            ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            query.intersect(scene, ray);
            benchmark::DoNotOptimize(ray);
        }
    });
}

void nearest_by_eight(RTCScene scene, const std::vector<RecordedRay>& rays) {
    in_chunks(rays.size(), [&](std::size_t begin, std::size_t end) {
        EmbreeQuery query(RayCoherence::incoherent);
        for (std::size_t first = begin; first < end; first += 8) {
            alignas(32) int valid[8];
            RTCRayHit8 packet;
            for (int i = 0; i < 8; ++i) {
                valid[i] = first + static_cast<std::size_t>(i) < end ? -1 : 0;
                set_ray(packet.ray, i, rays[std::min(end - 1, first + static_cast<std::size_t>(i))]);
                packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
            }
            query.intersect(scene, valid, packet);
            benchmark::DoNotOptimize(packet);
        }
    });
}

void any_singly(RTCScene scene, const std::vector<RecordedRay>& rays) {
    in_chunks(rays.size(), [&](std::size_t begin, std::size_t end) {
        EmbreeQuery query(RayCoherence::incoherent);
        for (std::size_t i = begin; i < end; ++i) {
            RTCRay ray = single_ray(rays[i]);
            query.occluded(scene, ray);
            benchmark::DoNotOptimize(ray);
        }
    });
}

void any_by_sixteen(RTCScene scene, const std::vector<RecordedRay>& rays) {
    in_chunks(rays.size(), [&](std::size_t begin, std::size_t end) {
        EmbreeQuery query(RayCoherence::incoherent);
        for (std::size_t first = begin; first < end; first += 16) {
            alignas(64) int valid[16];
            RTCRay16 packet;
            for (int i = 0; i < 16; ++i) {
                valid[i] = first + static_cast<std::size_t>(i) < end ? -1 : 0;
                set_ray(packet, i, rays[std::min(end - 1, first + static_cast<std::size_t>(i))]);
            }
            query.occluded(scene, valid, packet);
            benchmark::DoNotOptimize(packet);
        }
    });
}

struct RenderCase {
    std::string name;
    std::vector<std::string> planes;
    int bounces = 1;
    bool antialias = false;
    Falloff falloff = Falloff::quadratic;
    int roulette_after = 0;  // as ReferenceSettings
    int samples = 16;
};

// A scene with all that is made of it once.
struct BenchmarkScene {
    explicit BenchmarkScene(Scene read) : scene(std::move(read)), tracer(scene), traced(scene) {}

    View view() const { return View(scene.cameras.front(), view_size, view_size); }
    ReferenceSettings settings(const RenderCase& asked) const {
        ReferenceSettings settings;
        settings.quantities.planes = asked.planes;
        settings.quantities.bounces = asked.bounces;
        settings.quantities.ao_falloff = asked.falloff;
        settings.antialias = asked.antialias;
        settings.samples = asked.samples;
        settings.roulette_after = asked.roulette_after;
        return settings;
    }

    Scene scene;
    PathTracer tracer;
    TracedScene traced;
};

void render(benchmark::State& state, const std::shared_ptr<BenchmarkScene>& with, const RenderCase& asked) {
    const ReferenceSettings settings = with->settings(asked);
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
            nearest_singly(with->traced.embree_scene(), recorder.nearest());
            (only_any ? any_by_sixteen : any_singly)(with->traced.embree_scene(), recorder.any());
        }));
        state.SetIterationTime(ours.back());
    }
    const double our_rate = recorded / median(ours), bare_rate = recorded / median(bare);
    state.counters["Mrays/s"] = our_rate * 1e-6;
    state.counters["bare Mrays/s"] = bare_rate * 1e-6;
    state.counters["ratio"] = our_rate / bare_rate;
    state.counters["Msamples/s"] = asked.samples * view_size * view_size / median(ours) * 1e-6;
}

void trace(benchmark::State& state, const std::shared_ptr<BenchmarkScene>& with, const RenderCase& asked, bool nearest,
           void (*bare)(RTCScene, const std::vector<RecordedRay>&)) {
    RayRecorder recorder;
    with->tracer.set_recorder(&recorder);
    with->tracer.render(with->view(), with->settings(asked));
    with->tracer.set_recorder(nullptr);
    const std::vector<RecordedRay>& rays = nearest ? recorder.nearest() : recorder.any();
    for (auto _ : state) bare(with->traced.embree_scene(), rays);
    state.counters["rays/s"] =
        benchmark::Counter(static_cast<double>(rays.size()), benchmark::Counter::kIsIterationInvariantRate);
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
    const RenderCase paths{"paths, 8 bounces, anti-aliased", {"total"}, 8, true};
    // What production path tracers do by default: rays per sample fall, samples per second rise.
    const RenderCase roulette{
        "paths, 8 bounces, anti-aliased, roulette after 1", {"total"}, 8, true, Falloff::quadratic, 1};
    // More of its samples, which are cheap, so that what is done once for a view is as small a share as in use.
    const RenderCase visibility{"ao, hard", {"ao"}, 1, false, Falloff::hard, 0, 64};
    const std::vector<RenderCase> cases = {visibility,
                                           {"ao, quadratic", {"ao"}, 1, false, Falloff::quadratic, 0, 64},
                                           {"direct", {"direct"}},
                                           {"indirect.1", {"indirect.1"}},
                                           {"ao, direct, indirect of 3 bounces", {"ao", "direct", "indirect"}, 3},
                                           paths,
                                           roulette};
    for (const RenderCase& asked : cases) {
        benchmark::RegisterBenchmark(fmt::format("render/{}/{}", name, asked.name).c_str(), render, with, asked)
            ->Unit(benchmark::kMillisecond)
            ->Iterations(5)
            ->UseManualTime();
    }
    const auto add_trace = [&](const char* way, const RenderCase& asked, bool nearest, auto bare) {
        benchmark::RegisterBenchmark(fmt::format("packets/{}/{}", name, way).c_str(), trace, with, asked, nearest, bare)
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime();
    };
    add_trace("bounces, singly", paths, true, nearest_singly);
    add_trace("bounces, by 8", paths, true, nearest_by_eight);
    add_trace("shadow rays, singly", paths, false, any_singly);
    add_trace("shadow rays, by 16", paths, false, any_by_sixteen);
    add_trace("ao, singly", visibility, false, any_singly);
    add_trace("ao, by 16", visibility, false, any_by_sixteen);
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

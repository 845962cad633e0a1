// What the cases of bench_pathtracer have in common: a scene with all that is made of it once, and what is rendered.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pathtracer/reference.h"
#include "pathtracer/traced_scene.h"

namespace plumb {

constexpr int benchmark_view_size = 256;

struct RenderCase {
    std::string name;
    std::vector<std::string> planes;
    int bounces = 1;
    bool antialias = false;
    Falloff falloff = Falloff::quadratic;
    int roulette_after = 0;  // as ReferenceSettings
    int samples = 16;

    ReferenceSettings settings() const {
        ReferenceSettings settings;
        settings.quantities.planes = planes;
        settings.quantities.bounces = bounces;
        settings.quantities.ao_falloff = falloff;
        settings.antialias = antialias;
        settings.samples = samples;
        settings.roulette_after = roulette_after;
        return settings;
    }
};

struct BenchmarkScene {
    explicit BenchmarkScene(Scene read) : scene(std::move(read)), tracer(scene), traced(scene) {}

    View view() const { return View(scene.cameras.front(), benchmark_view_size, benchmark_view_size); }

    Scene scene;
    PathTracer tracer;
    TracedScene traced;
};

// Production path tracers' longest paths, and the plainest ambient visibility. Its samples are cheap: as many of them
// as references take, so that what is done once for a view is as small a share as in use.
inline RenderCase path_case() { return {"paths, 8 bounces, anti-aliased", {"total"}, 8, true}; }
inline RenderCase visibility_case() { return {"ao, hard", {"ao"}, 1, false, Falloff::hard, 0, 256}; }

// Cases `packets/`: the rays of those two, and primary rays, traced in all ways that Embree has, which is what the path
// tracer's choice of calls rests on.
void add_packet_benchmarks(const std::string& name, const std::shared_ptr<BenchmarkScene>& scene);

}  // namespace plumb

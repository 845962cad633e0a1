// What the layers of the G-buffer cost over the number of triangles, at three sizes: one layer, two passes against one,
// and layers selected by a geometry shader against the vertex shader: `bench_gbuffer --benchmark_filter=delay`.
//
// The scene is four wavy sheets, one behind the other, that fill the view: what grows is the number of triangles alone.
// `fragments` are those that rasterizing them gives, over all layers that they are sent to; most fail a depth test.
// Times are the pipeline's own, of frames that have a history.
#include <cmath>
#include <map>
#include <string>

#include <benchmark/benchmark.h>

#include "rasterizer/benchmark_context.h"
#include "rasterizer/pipeline.h"
#include "rasterizer/plane_textures.h"

namespace plumb {
namespace {

constexpr int sheet_count = 4;

// Sheets of 2 * side^2 triangles each.
const Scene& sheets(int side) {
    static std::map<int, Scene> made;
    Scene& scene = made[side];
    if (!scene.meshes.empty()) return scene;
    scene.name = "sheets";
    scene.materials.emplace_back();
    for (int sheet = 0; sheet < sheet_count; ++sheet) {
        Mesh mesh;
        mesh.name = "sheet";
        const float z = -2.0f - static_cast<float>(sheet);
        for (int y = 0; y <= side; ++y) {
            for (int x = 0; x <= side; ++x) {
                const float u = 8.0f * (static_cast<float>(x) / static_cast<float>(side) - 0.5f);
                const float v = 8.0f * (static_cast<float>(y) / static_cast<float>(side) - 0.5f);
                mesh.positions.push_back({u, v, z + 0.2f * std::sin(3.0f * u) * std::cos(2.0f * v)});
                mesh.normals.push_back({0.0f, 0.0f, 1.0f});
            }
        }
        const auto at = [&](int x, int y) { return static_cast<unsigned>(y * (side + 1) + x); };
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
                mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
            }
        }
        scene.instances.push_back({"sheet", sheet});
        scene.meshes.push_back(std::move(mesh));
    }
    return scene;
}

struct GBufferCase {
    const char* name;
    int layers;
    LayerGeneration generation;
    LayerSelection selection;
};
constexpr LayerSelection geometry = LayerSelection::geometry_shader, vertex = LayerSelection::vertex_shader;
constexpr GBufferCase cases[] = {{"one layer", 1, LayerGeneration::peel, geometry},
                                 {"peel, 2 layers", 2, LayerGeneration::peel, geometry},
                                 {"peel, 3 layers", 3, LayerGeneration::peel, geometry},
                                 {"peel, 4 layers", 4, LayerGeneration::peel, geometry},
                                 {"delay, geometry shader", 2, LayerGeneration::delay, geometry},
                                 {"delay, vertex shader", 2, LayerGeneration::delay, vertex},
                                 {"previous, geometry shader", 2, LayerGeneration::previous, geometry},
                                 {"previous, vertex shader", 2, LayerGeneration::previous, vertex},
                                 {"predict, geometry shader", 2, LayerGeneration::predict, geometry},
                                 {"predict, vertex shader", 2, LayerGeneration::predict, vertex},
                                 {"reproject, geometry shader", 2, LayerGeneration::reproject, geometry},
                                 {"reproject, vertex shader", 2, LayerGeneration::reproject, vertex}};

// How many layers' worth of depth every triangle is drawn to: delay and predict draw that of the next frame besides.
int drawn_layers(const GBufferCase& asked) {
    const bool looks_ahead = asked.generation == LayerGeneration::delay || asked.generation == LayerGeneration::predict;
    return asked.layers + (looks_ahead ? 1 : 0);
}

// Arguments: height of the image, triangles along a side of a sheet.
void measure(benchmark::State& state, const GBufferCase& asked) {
    const Scene& scene = sheets(static_cast<int>(state.range(1)));
    Method method;
    method.gbuffer.layers = asked.layers;
    method.gbuffer.generation = asked.generation;
    method.gbuffer.layer_selection = asked.selection;
    method.gbuffer.minimum_separation = 0.5f;
    Quantities quantities;
    for (int layer = 0; layer < asked.layers; ++layer) {
        for (const char* plane : {"depth", "normal", "albedo"})
            quantities.planes.push_back(layer_prefix(layer) + plane);
    }
    const int height = static_cast<int>(state.range(0)), width = height * 16 / 9;
    try {
        Pipeline pipeline(benchmark_context(), scene, method, quantities, width, height);
        const View view(Camera::look_at("front", {0, 0, 0}, {0, 0, -1}, 0.9f), width, height);
        for (int i = 0; i < 2; ++i) pipeline.time_passes(view);  // shaders are compiled, history is there
        for ([[maybe_unused]] auto _ : state) {
            double milliseconds = 0.0;
            for (const PassTiming& timing : pipeline.time_passes(view)) milliseconds += timing.milliseconds;
            state.SetIterationTime(1e-3 * milliseconds);
        }
        state.counters["bytes_per_pixel"] = static_cast<double>(pipeline.gbuffer_bytes_per_pixel());
    } catch (const std::exception& error) {
        state.SkipWithError(error.what());
        return;
    }
    state.counters["triangles"] = static_cast<double>(scene.triangle_count());
    const double pixels = static_cast<double>(width) * height;
    state.counters["pixels"] = pixels;
    state.counters["fragments"] = pixels * sheet_count * drawn_layers(asked);
    state.SetLabel(benchmark_context().info().renderer);
}

}  // namespace
}  // namespace plumb

int main(int argument_count, char** arguments) {
    benchmark::Initialize(&argument_count, arguments);
    if (benchmark::ReportUnrecognizedArguments(argument_count, arguments)) return 2;
    for (const plumb::GBufferCase& one : plumb::cases) {
        benchmark::RegisterBenchmark(one.name, [&one](benchmark::State& state) { plumb::measure(state, one); })
            ->ArgsProduct({{180, 360, 720}, {16, 64, 256}})
            ->ArgNames({"height", "side"})
            ->UseManualTime()
            ->Iterations(7)
            ->Unit(benchmark::kMillisecond);
    }
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}

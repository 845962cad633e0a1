// The two renderers see the same thing: the first condition for comparing what they make of it.
#include "tests/agreement/gbuffer_agreement.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "frames/picture.h"
#include "pathtracer/reference.h"
#include "rasterizer/gl_context.h"
#include "rasterizer/pipeline.h"
#include "scenes/builtin.h"
#include "scenes/scene_file.h"

namespace plumb::test {
namespace {

std::string layer_prefix(int layer) { return layer == 1 ? "" : fmt::format("layer{}.", layer); }

// Two hundredths of the scene's size separate the layers: a hand's breadth in a room, half a metre in an atrium.
float separation_for(const Scene& scene) { return 0.02f * scene.bounds().diagonal(); }

// As many as can be peeled.
constexpr int compared_layers = 4;

Frame rasterized_gbuffer(GlContext& context, const Scene& scene, const View& view) {
    Method method;
    method.gbuffer.layers = compared_layers;
    method.gbuffer.minimum_separation = separation_for(scene);
    Quantities quantities;
    for (int layer = 1; layer <= compared_layers; ++layer) {
        for (const char* plane : {"depth", "normal", "albedo"})
            quantities.planes.push_back(layer_prefix(layer) + plane);
    }
    return Pipeline(context, scene, method, quantities, view.width(), view.height()).render(view).frame;
}

// 1 where another surface lies within 1e-6 of the depth of `depth`'s, or does in a neighbouring pixel: two surfaces
// that round to the very same distance count as one hit, but not for a whole neighbourhood. `all` holds every hit of
// each ray.
Image coincident_surfaces(const Frame& all, int layers, const Image& depth) {
    constexpr float relative_rounding = 1e-6f;  // some eight units in the last place of a float
    Image mask(depth.width(), depth.height(), 1);
    for (int y = 0; y < depth.height(); ++y) {
        for (int x = 0; x < depth.width(); ++x) {
            int there = 0;
            for (int layer = 1; layer <= layers; ++layer) {
                const float other = all.plane(layer_prefix(layer) + "depth").at(x, y);
                there += std::abs(other - depth.at(x, y)) <= relative_rounding * depth.at(x, y);
            }
            if (there < 2) continue;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, depth.height() - 1); ++v) {
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, depth.width() - 1); ++u) mask.at(u, v) = 1.0f;
            }
        }
    }
    return mask;
}

void save_difference(const std::string& name, const Image& wrong) {
    const auto picture = std::filesystem::path("agreement") / (name + ".png");
    write_png(picture, picture_of_scalar(wrong));
    ADD_FAILURE() << "difference image: " << std::filesystem::absolute(picture);
}

struct Expectation {
    double least_explained_of_each = 0.999;  // of each view and layer
    double least_of_all = 0.999;             // over all views and layers, nothing explained away
};

void expect_agreement(GlContext& context, const Scene& scene, const Expectation& expected) {
    constexpr int all_layers = 12;  // hits of a ray that are looked through for coincident surfaces
    const PathTracer path_tracer(scene);
    AgreementCount total;
    int surfaces_in_last_layer = 0;
    for (const Camera& camera : scene.cameras) {
        const View view(camera, 480, 270);
        const Frame exact =
            path_tracer.gbuffer(view, {.layers = compared_layers, .minimum_separation = separation_for(scene)});
        const Frame rasterized = rasterized_gbuffer(context, scene, view);
        for (const float depth : exact.plane(layer_prefix(compared_layers) + "depth").values())
            surfaces_in_last_layer += std::isfinite(depth);
        // A silhouette of a layer is one of those behind it, whose separation test starts from it.
        Image at_silhouettes(view.width(), view.height(), 1);
        for (int layer = 1; layer <= compared_layers; ++layer) {
            const Image of_layer = silhouettes(exact, view, layer);
            std::ranges::transform(of_layer.values(), at_silhouettes.values(), at_silhouettes.values().begin(),
                                   [](float a, float b) { return std::max(a, b); });
            const std::string prefix = layer_prefix(layer);
            const Image none(view.width(), view.height(), 1);
            AgreementCount count = compare_gbuffers(rasterized, exact, prefix, at_silhouettes, none);
            if (count.agreeing < count.pixels) {
                const Frame every_hit = path_tracer.gbuffer(view, {.layers = all_layers, .minimum_separation = 0.0f});
                const Image coincident = coincident_surfaces(every_hit, all_layers, exact.plane(prefix + "depth"));
                count = compare_gbuffers(rasterized, exact, prefix, at_silhouettes, coincident);
            }
            const std::string name =
                fmt::format("{}-{}-layer{}-{}", scene.name, camera.name, layer, to_string(context.info().backend));
            fmt::print("{}: {}\n", name, count.summary());
            total.add(count);
            EXPECT_GT(count.pixels, view.width() * view.height() / 4) << name << ": too few pixels to tell";
            EXPECT_GE(count.explained_fraction(), expected.least_explained_of_each) << name << ": " << count.summary();
            if (count.explained_fraction() < expected.least_explained_of_each) save_difference(name, count.wrong);
        }
    }
    fmt::print("{}, all views and layers: {}\n", scene.name, total.summary());
    EXPECT_GT(surfaces_in_last_layer, 500) << scene.name << ": too few to tell of the last layer";
    EXPECT_GE(total.fraction(), expected.least_of_all) << scene.name << ": " << total.summary();
}

class GBufferAgreement : public testing::TestWithParam<std::tuple<std::string, GlBackend>> {};

TEST_P(GBufferAgreement, BothRenderersSeeTheSameSurfacesOnEveryBuiltInView) {
    const auto& [scene_name, backend] = GetParam();
    const auto context = GlContext::create(backend);
    expect_agreement(*context, make_builtin_scene(scene_name), {});
}

INSTANTIATE_TEST_SUITE_P(BuiltInScenes, GBufferAgreement,
                         testing::Combine(testing::ValuesIn(builtin_scene_names()),
                                          testing::Values(GlBackend::egl, GlBackend::osmesa)),
                         [](const auto& parameter) {
                             return fmt::format("{}_{}", std::get<0>(parameter.param),
                                                to_string(std::get<1>(parameter.param)));
                         });

// Real meshes: open, self-intersecting, with coincident surfaces and strongly minified textures read at level 0.
class GBufferAgreementOnMeshes : public testing::TestWithParam<std::string> {};

TEST_P(GBufferAgreementOnMeshes, BothRenderersSeeTheSameSurfaces) {
    const auto scenes_dirs = scenes_dirs_of_environment();
    if (scenes_dirs.empty()) GTEST_SKIP() << "PLUMBLINE_SCENES is not set; it names the folder of real meshes";
    const Scene scene = load_scene(GetParam(), scenes_dirs);
    for (const GlBackend backend : {GlBackend::egl, GlBackend::osmesa}) {
        const auto context = GlContext::create(backend);
        expect_agreement(*context, scene, {.least_explained_of_each = 0.995, .least_of_all = 0.995});
    }
}

INSTANTIATE_TEST_SUITE_P(RealMeshes, GBufferAgreementOnMeshes, testing::Values("crytek-sponza", "conference"),
                         [](const auto& parameter) {
                             std::string name = parameter.param;
                             std::erase(name, '-');
                             return name;
                         });

}  // namespace
}  // namespace plumb::test

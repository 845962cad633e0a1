// The two renderers see the same thing: the first condition for comparing what they make of it.
#include "tests/agreement/gbuffer_agreement.h"

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

const std::vector<std::string> gbuffer_planes = {"depth",        "normal",        "albedo",
                                                 "layer2.depth", "layer2.normal", "layer2.albedo"};

// Two hundredths of the scene's size separate the layers: a hand's breadth in a room, half a metre in an atrium.
float separation_for(const Scene& scene) { return 0.02f * scene.bounds().diagonal(); }

Frame exact_gbuffer(const Scene& scene, const View& view) {
    ReferenceSettings settings;
    settings.quantities.planes = gbuffer_planes;
    settings.minimum_separation = separation_for(scene);
    return PathTracer(scene).render(view, settings).frame;
}

Frame rasterized_gbuffer(GlContext& context, const Scene& scene, const View& view) {
    Method method;
    method.gbuffer.layers = 2;
    method.gbuffer.minimum_separation = separation_for(scene);
    Quantities quantities;
    quantities.planes = gbuffer_planes;
    return Pipeline(context, scene, method, quantities, view.width(), view.height()).render(view).frame;
}

void expect_agreement(GlContext& context, const Scene& scene, const std::string& label, double least_fraction) {
    for (const Camera& camera : scene.cameras) {
        const View view(camera, 480, 270);
        const Frame exact = exact_gbuffer(scene, view);
        const Frame rasterized = rasterized_gbuffer(context, scene, view);
        for (const std::string prefix : {"", "layer2."}) {
            const AgreementCount count = compare_gbuffers(view, rasterized, exact, prefix);
            const std::string name = fmt::format("{}-{}-{}{}", scene.name, camera.name, prefix, label);
            fmt::print("{}: {}\n", name, count.summary());
            EXPECT_GT(count.pixels, view.width() * view.height() / 4) << name << ": too few pixels away from edges";
            EXPECT_GE(count.fraction(), least_fraction) << name << ": " << count.summary();
            if (count.fraction() < least_fraction) {
                const auto picture = std::filesystem::path("agreement") / (name + ".png");
                write_png(picture, "wrong", count.wrong);
                ADD_FAILURE() << "difference image: " << std::filesystem::absolute(picture);
            }
        }
    }
}

class GBufferAgreement : public testing::TestWithParam<std::tuple<std::string, GlBackend>> {};

TEST_P(GBufferAgreement, BothRenderersSeeTheSameSurfacesOnEveryBuiltInView) {
    const auto& [scene_name, backend] = GetParam();
    const auto context = GlContext::create(backend);
    expect_agreement(*context, make_builtin_scene(scene_name), std::string(to_string(backend)), 0.999);
}

// Real meshes: open, self-intersecting, with coincident surfaces and minified textures read at level 0.
class GBufferAgreementOnMeshes : public testing::TestWithParam<std::string> {};

TEST_P(GBufferAgreementOnMeshes, BothRenderersSeeTheSameSurfaces) {
    const auto scenes_dirs = scenes_dirs_of_environment();
    if (scenes_dirs.empty()) GTEST_SKIP() << "PLUMBLINE_SCENES is not set; it names the folder of real meshes";
    const Scene scene = load_scene(GetParam(), scenes_dirs);
    for (const GlBackend backend : {GlBackend::egl, GlBackend::osmesa}) {
        const auto context = GlContext::create(backend);
        expect_agreement(*context, scene, std::string(to_string(backend)), 0.995);
    }
}

INSTANTIATE_TEST_SUITE_P(RealMeshes, GBufferAgreementOnMeshes, testing::Values("crytek-sponza", "conference"),
                         [](const auto& parameter) {
                             std::string name = parameter.param;
                             std::erase(name, '-');
                             return name;
                         });

INSTANTIATE_TEST_SUITE_P(BuiltInScenes, GBufferAgreement,
                         testing::Combine(testing::ValuesIn(builtin_scene_names()),
                                          testing::Values(GlBackend::egl, GlBackend::osmesa)),
                         [](const auto& parameter) {
                             return fmt::format("{}_{}", std::get<0>(parameter.param),
                                                to_string(std::get<1>(parameter.param)));
                         });

}  // namespace
}  // namespace plumb::test

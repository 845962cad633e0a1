// Reflections as the pipeline runs them: the planes of the G-buffer that they read, their place in the sum, and what
// cannot be combined.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gl_test.h"
#include "light_scenes.h"
#include "rasterizer/gl_error.h"
#include "scenes/specular_albedo.h"

namespace plumb {
namespace {

using ReflectionsPipelineTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(ReflectionsPipelineTest);

// A dielectric floor, a metal wall, and a wall without a specular lobe.
Scene make_glossy_corner() {
    Scene scene = make_corner();
    scene.materials.resize(3);
    scene.materials[0].dielectric_reflectance = 0.04f;
    scene.materials[0].roughness = 0.25f;
    scene.materials[1].metallic = 0.75f;
    scene.materials[1].roughness = 0.5f;
    scene.materials[2].base_colour = {0.4f, 0.7f, 0.6f};
    scene.meshes[2].material = 2;
    scene.point_lights.push_back({"lamp", {0.4f, 1.9f, 0.9f}, {9.0f, 7.0f, 5.0f}});
    return scene;
}

Method reflecting_method() {
    Method method = plain_method();
    method.reflections.enabled = true;
    return method;
}

TEST_P(ReflectionsPipelineTest, TheGBufferKeepsWhatTheMaterialSays) {
    const Scene scene = make_glossy_corner();
    const View view = corner_view();
    const Frame frame =
        render(context(), scene, view,
               {"albedo", "diffuse_albedo", "specular", "roughness", "depth", "normal", "position"}, plain_method());
    const SpecularAlbedo table;
    std::array<int, 3> seen{};
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            if (std::isinf(frame.plane("depth").at(x, y))) continue;
            const glm::dvec3 albedo = vector_at(frame.plane("albedo"), x, y);
            const auto is = [&](int material) {
                const SurfaceSample sample = scene.surface(scene.materials[material], {0.0f, 0.0f});
                return glm::length(albedo - glm::dvec3(sample.albedo)) < 2e-3;
            };
            const int material = is(0) ? 0 : is(1) ? 1 : 2;
            ++seen[static_cast<std::size_t>(material)];
            const SurfaceSample expected = scene.surface(scene.materials[material], {0.0f, 0.0f});
            const glm::vec3 n(vector_at(frame.plane("normal"), x, y)), p(vector_at(frame.plane("position"), x, y));
            const float cosine = glm::dot(n, glm::normalize(view.camera().position() - p));
            const glm::vec3 specular =
                table.albedo(expected.specular_f0, expected.specular_f90, cosine, ggx_alpha(expected.roughness));
            // Half floats; the table's bilinear weights of 8 bits.
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(frame.plane("specular").at(x, y, c), expected.specular_f0[c], 5e-4f) << x << ", " << y;
                ASSERT_NEAR(frame.plane("diffuse_albedo").at(x, y, c), expected.albedo[c] * (1.0f - specular[c]), 2e-3f)
                    << x << ", " << y << ", material " << material;
            }
            ASSERT_NEAR(frame.plane("roughness").at(x, y), expected.roughness, 5e-4f);
        }
    }
    for (const int count : seen) EXPECT_GT(count, 300);
}

TEST_P(ReflectionsPipelineTest, WhatIsNotGlossyReflectsNothingAndTheSumHoldsWhatTheRestReflects) {
    const Scene scene = make_glossy_corner();
    const Frame frame = render(context(), scene, corner_view(), {"reflection", "direct", "total", "specular", "depth"},
                               reflecting_method());
    int bright = 0;
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            const glm::dvec3 reflection = vector_at(frame.plane("reflection"), x, y);
            bright += reflection.y > 0.05;
            if (vector_at(frame.plane("specular"), x, y) == glm::dvec3(0.0)) {
                ASSERT_EQ(glm::length(reflection), 0.0) << x << ", " << y;
            }
            if (std::isinf(frame.plane("depth").at(x, y))) continue;
            // Sums of floats.
            ASSERT_LT(glm::length(vector_at(frame.plane("total"), x, y) - vector_at(frame.plane("direct"), x, y) -
                                  reflection),
                      1e-5 * (1.0 + glm::length(reflection)));
        }
    }
    EXPECT_GT(bright, 500);
}

TEST_P(ReflectionsPipelineTest, LeavesAMattSceneAsItWasBitForBit) {
    Scene scene = make_corner();
    scene.point_lights.push_back({"lamp", {0.4f, 1.9f, 0.9f}, {9.0f, 7.0f, 5.0f}});
    const Image without = render(context(), scene, corner_view(), {"total"}, plain_method()).plane("total");
    const Image with = render(context(), scene, corner_view(), {"total"}, reflecting_method()).plane("total");
    EXPECT_TRUE(std::ranges::equal(without.values(), with.values()));
}

TEST_P(ReflectionsPipelineTest, AProbeFillsWhatTheViewDoesNotShow) {
    Scene scene = make_glossy_corner();
    scene.materials[0].roughness = 0.0f;
    const View view = near_view();
    Method method = reflecting_method();
    method.direct.shadow.lamps = false;
    method.probe.size = 32;
    method.environment.samples = 16;
    const auto brightness = [&] {
        double sum = 0.0;
        const Image image = render(context(), scene, view, {"reflection"}, method).plane("reflection");
        for (const float value : image.values()) sum += value;
        return sum;
    };
    const double none = brightness();
    method.reflections.fallback = ReflectionFallback::probe;
    method.probe.y = 1.0f;
    EXPECT_GT(brightness(), 1.05 * none);
}

TEST_P(ReflectionsPipelineTest, AllocatesNothingAfterTheFirstFrame) {
    const Scene scene = make_glossy_corner();
    const View view(corner_view().camera(), 32, 24);
    Method method = reflecting_method();
    method.direct.shadow.cube_size = 64;
    method.reflections.roughness = ReflectionRoughness::samples;
    method.reflections.samples = 40;  // more than one draw
    Pipeline pipeline(context(), scene, method, {.planes = {"reflection"}}, view.width(), view.height());
    const Image first = pipeline.render(view).frame.plane("reflection");
    const std::size_t bytes = context().allocated_bytes();
    const Image second = pipeline.render(view).frame.plane("reflection");
    EXPECT_EQ(context().allocated_bytes(), bytes);
    EXPECT_TRUE(std::ranges::equal(first.values(), second.values())) << "the same view, the same bits";
}

TEST_P(ReflectionsPipelineTest, WhatCannotBeCombinedIsAnErrorThatSaysSo) {
    const Scene scene = make_glossy_corner();
    const auto expect_error = [&](const Method& method, const char* what) {
        try {
            render(context(), scene, corner_view(), {"reflection"}, method);
            ADD_FAILURE() << what;
        } catch (const MethodError& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr(what));
        }
    };
    Method method = plain_method();
    expect_error(method, "method.reflections.enabled is false");
    method = reflecting_method();
    method.gbuffer.layers = 1;
    expect_error(method, "gbuffer.layers is 1");
    method = reflecting_method();
    method.gbuffer.source = SourceOfStage::truth;
    expect_error(method, "gbuffer.source is \"truth\"");
    method = reflecting_method();
    method.reflections.fallback = ReflectionFallback::environment;
    expect_error(method, "the scene has no environment");
    method.reflections.fallback = ReflectionFallback::probe;
    try {
        const Quantities near{.planes = {"reflection"}, .reflection_radius = 2.0f};
        const Pipeline pipeline(context(), scene, method, near, 16, 12);
        ADD_FAILURE() << "a fallback beyond the radius within which reflections count";
    } catch (const MethodError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("reflections.fallback is \"probe\""));
    }
}

}  // namespace
}  // namespace plumb

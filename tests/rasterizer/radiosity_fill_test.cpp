// What is made of gathered light: boost, the fill of low confidence, and the demo's composite.
#include <functional>

#include <gmock/gmock.h>

#include "gl_test.h"
#include "light_scenes.h"
#include "radiosity_agreement.h"
#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

using RadiosityFillTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(RadiosityFillTest);

constexpr double pi = std::numbers::pi;

Quantities wanted(std::vector<std::string> planes) { return {.planes = std::move(planes)}; }

TEST_P(RadiosityFillTest, BoostFollowsTheSaturationOfTheIncomingLight) {
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(40, 30), 3);
    const RadiositySettings settings{.bounces = 2, .saturated_boost = 2.0f, .unsaturated_boost = 0.5f};
    Method method = unblurred(settings);
    method.gbuffer.radiance_format = RadianceFormat::rgba32f;
    ScreenSpaceRun run(context(), noise, method, wanted({"indirect", "indirect.1", "irradiance"}));
    const Image first = run.render("radiosity", 3), second = run.render("radiosity.2", 3),
                reflected = run.render("indirect.1", 3), indirect = run.render("indirect", 3);
    int coloured = 0;
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 40; ++x) {
            const glm::dvec3 a = counterpart::boosted(settings, vector_at(first, x, y)),
                             b = counterpart::boosted(settings, vector_at(second, x, y));
            // Float rounding; the albedo is 0.5.
            ASSERT_LT(glm::length(vector_at(reflected, x, y) - 0.5 / pi * a), 1e-6 * (1.0 + glm::length(a)));
            ASSERT_LT(glm::length(vector_at(indirect, x, y) - 0.5 / pi * (a + b)), 1e-6 * (1.0 + glm::length(a + b)));
            coloured += glm::length(a - 0.5 * vector_at(first, x, y)) > 0.1;
        }
    }
    EXPECT_GT(coloured, 100);
}

using AmbientByNormal = std::function<glm::dvec3(const glm::dvec3& normal)>;

// Irradiance and indirect light of the same method with and without the fill, and what it is filled with.
void expect_fill(const Frame& filled, const Frame& unfilled, const AmbientByNormal& ambient, double tolerance) {
    int low = 0;
    for (int y = 0; y < filled.height(); ++y) {
        for (int x = 0; x < filled.width(); ++x) {
            if (std::isinf(unfilled.plane("depth").at(x, y))) {
                ASSERT_EQ(vector_at(filled.plane("indirect"), x, y), glm::dvec3(0.0));
                continue;
            }
            const double confidence = unfilled.plane("confidence").at(x, y);
            const glm::dvec3 expected = confidence * vector_at(unfilled.plane("irradiance"), x, y) +
                                        (1.0 - confidence) * ambient(vector_at(unfilled.plane("normal"), x, y));
            const glm::dvec3 actual = vector_at(filled.plane("irradiance"), x, y);
            ASSERT_LT(glm::length(actual - expected), tolerance * (1.0 + glm::length(expected)))
                << "pixel (" << x << ", " << y << "): " << actual.x << ", expected " << expected.x;
            const glm::dvec3 reflected = vector_at(filled.plane("albedo"), x, y) / pi * expected;
            ASSERT_LT(glm::length(vector_at(filled.plane("indirect"), x, y) - reflected),
                      tolerance * (1.0 + glm::length(reflected)));
            low += confidence < 0.5;
        }
    }
    EXPECT_GT(low, 100) << "pixels of low confidence";
}

const std::vector<std::string> planes_of_fill = {"irradiance", "indirect", "confidence", "albedo", "depth", "normal"};

AmbientByNormal everywhere(const glm::dvec3& irradiance) {
    return [irradiance](const glm::dvec3&) { return irradiance; };
}

TEST_P(RadiosityFillTest, LowConfidenceIsFilledWithAConstant) {
    Scene scene = make_corner();
    scene.point_lights.push_back({"lamp", {0.5f, 1.5f, 0.5f}, {5.0f, 4.0f, 3.0f}});
    for (const int bounces : {1, 3}) {
        Method method;
        method.radiosity.bounces = bounces;
        const Frame unfilled = render(context(), scene, corner_view(), planes_of_fill, method);
        method.radiosity.fill = AmbientSource::ambient;
        method.radiosity.ambient = 0.25f;
        const Frame filled = render(context(), scene, corner_view(), planes_of_fill, method);
        expect_fill(filled, unfilled, everywhere(glm::dvec3(0.25 * pi)), 1e-5);  // float rounding
    }
}

TEST_P(RadiosityFillTest, OrWithTheEnvironmentByTheNormal) {
    Scene scene = make_corner();
    Texture sky;  // radiance 1 + 0.8 y
    sky.width = 8, sky.height = 128, sky.wrap_v = TextureWrap::clamp;
    for (int row = 0; row < sky.height; ++row) {
        const auto value = static_cast<float>(1.0 + 0.8 * std::cos(pi * (row + 0.5) / sky.height));
        for (int i = 0; i < sky.width; ++i) {
            for (const float channel : {value, value, value, 1.0f}) sky.texels.emplace_back(channel);
        }
    }
    scene.textures.push_back(sky);
    scene.environment = {{1.0f, 0.5f, 2.0f}, 0};
    Method method;
    method.ao.enabled = false;
    method.environment.size = 64;
    const Frame unfilled = render(context(), scene, corner_view(), planes_of_fill, method);
    method.radiosity.fill = AmbientSource::environment;
    const Frame filled = render(context(), scene, corner_view(), planes_of_fill, method);
    // The integral of y over the cosine lobe is 2 pi / 3 n_y. Irradiance cubes of 16 texels are good to 1 %.
    const auto irradiance = [](const glm::dvec3& n) {
        return (pi + 0.8 * 2.0 * pi / 3.0 * n.y) * glm::dvec3(1.0, 0.5, 2.0);
    };
    expect_fill(filled, unfilled, irradiance, 0.01);
}

// A room whose black walls glow alike: a probe inside sees the same radiance everywhere, and taps find no reflected
// light at all.
TEST_P(RadiosityFillTest, OrWithTheProbe) {
    Scene scene;
    scene.name = "glowing room";
    scene.materials.resize(1);
    scene.materials[0].base_colour = {0.0f, 0.0f, 0.0f};
    scene.materials[0].emission = {1.0f, 2.0f, 0.5f};
    add_quad(scene, 0, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    add_quad(scene, 0, {-2, 3, -2}, {4, 0, 0}, {0, 0, 4});
    add_quad(scene, 0, {-2, 0, -2}, {4, 0, 0}, {0, 3, 0});
    add_quad(scene, 0, {2, 0, 2}, {-4, 0, 0}, {0, 3, 0});
    add_quad(scene, 0, {-2, 0, 2}, {0, 0, -4}, {0, 3, 0});
    add_quad(scene, 0, {2, 0, -2}, {0, 0, 4}, {0, 3, 0});
    const View view(Camera::look_at("inside", {1.5f, 2.0f, 1.5f}, {-1.0f, 0.5f, -1.0f}, 1.0f), 64, 48);
    Method method;
    method.ao.enabled = false;
    method.direct.emitters = false;
    method.probe = {.x = 0.2f, .y = 1.4f, .z = -0.3f, .size = 32};
    const Frame unfilled = render(context(), scene, view, planes_of_fill, method);
    method.radiosity.fill = AmbientSource::probe;
    const Frame filled = render(context(), scene, view, planes_of_fill, method);
    // `total`, which the probe holds, is kept as half floats, which hold 1, 2 and 0.5 exactly; sums over texels are
    // good to 1e-5.
    expect_fill(filled, unfilled, everywhere(pi * glm::dvec3(1.0, 2.0, 0.5)), 3e-5);
}

TEST_P(RadiosityFillTest, TheEnvironmentCannotFillWhereThereIsNone) {
    Method method;
    method.radiosity.fill = AmbientSource::environment;
    try {
        render(context(), make_corner(), corner_view(), {"indirect"}, method);
        ADD_FAILURE() << "no error";
    } catch (const MethodError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("the scene has no environment"));
    }
}

Scene lit_corner() {
    Scene scene = make_corner();
    scene.point_lights.push_back({"lamp", {0.5f, 1.5f, 0.5f}, {5.0f, 4.0f, 3.0f}});
    Material glow;
    glow.base_colour = {0.2f, 0.2f, 0.2f};
    glow.emission = {0.5f, 0.25f, 1.0f};
    scene.materials.push_back(glow);
    add_quad(scene, 2, {-0.6f, 0.0f, -0.4f}, {0.0f, 0.5f, 0.0f}, {0.6f, 0.0f, 0.2f});
    return scene;
}

TEST_P(RadiosityFillTest, TheDemosCompositeWeighsItsTerms) {
    const Scene scene = lit_corner();
    const std::vector<std::string> planes = {"total", "direct", "emission",   "indirect",
                                             "ao",    "depth",  "confidence", "albedo"};
    for (const AmbientSource fill : {AmbientSource::none, AmbientSource::ambient}) {
        Method method;
        method.composite = {.kind = CompositeKind::demo, .fill = fill, .ambient = 0.3f};
        const Frame frame = render(context(), scene, corner_view(), planes, method);
        const double ambient = fill == AmbientSource::none ? 0.0 : 0.3;
        int dimmed = 0;
        for (int y = 0; y < frame.height(); ++y) {
            for (int x = 0; x < frame.width(); ++x) {
                const auto plane = [&](const char* name) { return vector_at(frame.plane(name), x, y); };
                if (std::isinf(frame.plane("depth").at(x, y))) {
                    ASSERT_EQ(plane("total"), glm::dvec3(0.0));
                    continue;
                }
                const double visibility = 0.95 * frame.plane("ao").at(x, y) + 0.05;
                const double confidence =
                    std::clamp(2.0 * (frame.plane("confidence").at(x, y) - 0.35) + 0.35, 0.0, 1.0);
                const glm::dvec3 expected = plane("emission") + (0.35 + 0.65 * visibility) * plane("direct") +
                                            confidence * visibility * plane("indirect") +
                                            (1.0 - 0.7 * confidence) * visibility * ambient * plane("albedo");
                // `total` is kept as half floats: 5e-4 of the value.
                ASSERT_LT(glm::length(plane("total") - expected), 1e-3 * glm::length(expected) + 1e-6)
                    << "pixel (" << x << ", " << y << "): " << plane("total").x << ", expected " << expected.x;
                const glm::dvec3 physical = plane("emission") + plane("direct") + plane("indirect");
                dimmed += glm::length(expected) < 0.95 * glm::length(physical);
            }
        }
        EXPECT_GT(dimmed, 50);
    }
}

TEST_P(RadiosityFillTest, TheDemosCompositeWithoutRadiosityTakesAllFromAmbientLight) {
    Method method;
    method.composite = {.kind = CompositeKind::demo, .fill = AmbientSource::ambient, .ambient = 0.3f};
    method.radiosity.enabled = false;
    const Frame frame = render(context(), lit_corner(), corner_view(),
                               {"total", "direct", "emission", "ao", "depth", "albedo"}, method);
    int brighter = 0;
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            const auto plane = [&](const char* name) { return vector_at(frame.plane(name), x, y); };
            if (std::isinf(frame.plane("depth").at(x, y))) continue;
            const double visibility = 0.95 * frame.plane("ao").at(x, y) + 0.05;
            const glm::dvec3 expected =
                plane("emission") + (0.35 + 0.65 * visibility) * plane("direct") + visibility * 0.3 * plane("albedo");
            // `total` is kept as half floats: 5e-4 of the value.
            ASSERT_LT(glm::length(plane("total") - expected), 1e-3 * glm::length(expected) + 1e-6)
                << "pixel (" << x << ", " << y << "): " << plane("total").x << ", expected " << expected.x;
            brighter += plane("total").x > plane("direct").x;
        }
    }
    EXPECT_GT(brighter, 50);
}

TEST_P(RadiosityFillTest, TheDemosCompositeIsRefusedWithoutWhatItReads) {
    const auto error_of = [&](const Method& method) -> std::string {
        try {
            render(context(), lit_corner(), corner_view(), {"total"}, method);
        } catch (const MethodError& error) {
            return error.what();
        }
        return "no error";
    };
    Method method;
    method.composite.kind = CompositeKind::demo;
    EXPECT_EQ(error_of(method), "no error");
    Method changed = method;
    changed.ao.enabled = false;
    EXPECT_THAT(error_of(changed), testing::HasSubstr("set ao.enabled to true"));
    changed = method;
    changed.radiosity.enabled = false;
    EXPECT_THAT(error_of(changed), testing::HasSubstr("set radiosity.enabled to true, or composite.fill"));
    changed = method;
    changed.radiosity.fill = AmbientSource::ambient;
    EXPECT_THAT(error_of(changed), testing::HasSubstr("set composite.fill to what radiosity.fill is"));
    changed = method;
    changed.composite.ambient = -1.0f;
    EXPECT_THAT(error_of(changed), testing::HasSubstr("composite.ambient is -1"));
}

}  // namespace
}  // namespace plumb

#include "rasterizer/reflections.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gl_test.h"
#include "random_views.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/pipeline.h"
#include "rasterizer/scene_reach.h"
#include "reflection_scenes.h"
#include "scenes/builtin.h"
#include "screen_space_run.h"

namespace plumb {
namespace {

using ReflectionsTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(ReflectionsTest);

struct Count {
    int pixels = 0, ambiguous = 0, hits = 0, second_layer_hits = 0, wrong = 0;
    double ambiguous_share() const { return static_cast<double>(ambiguous) / pixels; }
};

Count expect_agreement(const counterpart::Layers& layers, const counterpart::Gloss& gloss,
                       const counterpart::ReflectionRequest& request, const Image& reflection, double tolerance) {
    const counterpart::ReflectionTracer tracer(layers, gloss, request);
    Count count;
    for (int y = 0; y < layers.height(); ++y) {
        for (int x = 0; x < layers.width(); ++x) {
            const counterpart::Reflected expected = tracer.reflect({x, y});
            ++count.pixels;
            count.ambiguous += expected.ambiguous;
            count.hits += expected.hits, count.second_layer_hits += expected.second_layer_hits;
            if (expected.ambiguous) continue;
            const auto found = reflection.pixel(x, layers.height() - 1 - y);
            bool right = true;
            for (int c = 0; c < 3; ++c) right = right && std::abs(found[c] - expected.radiance[c]) < tolerance;
            if (!right && ++count.wrong < 5) {
                ADD_FAILURE() << "pixel (" << x << ", " << y << ") from the bottom left: reflection " << found[0] << " "
                              << found[1] << " " << found[2] << "; expected " << expected.radiance.x << " "
                              << expected.radiance.y << " " << expected.radiance.z << ", " << expected.hits << " of "
                              << expected.rays << " rays hit";
            }
        }
    }
    EXPECT_EQ(count.wrong, 0);
    return count;
}

Count expect_agreement(GlContext& context, const counterpart::Layers& given, const counterpart::Gloss& gloss,
                       const ReflectionSettings& settings, const Quantities& quantities = reflection_alone,
                       const glm::vec3& sky = glm::vec3(0.0f)) {
    ReflectionRun run(context, given, gloss, method_of(settings), quantities, sky);
    // Float directions and weights are good to some 1e-6; the MIP chain's half floats, and the split sum's bilinear
    // weights of 8 bits between entries a tenth apart, to 1e-3 of radiances of at most 1.
    const double tolerance = settings.roughness == ReflectionRoughness::samples ? 1e-4 : 1.5e-3;
    return expect_agreement(run.layers(), gloss, request_of(settings, quantities, sky), run.render(), tolerance);
}

struct Case {
    const char* name;
    ReflectionSettings settings;
    float roughness = 0.0f;
};

constexpr auto mirror = ReflectionRoughness::mirror;
constexpr auto mip = ReflectionRoughness::mip;
constexpr auto samples = ReflectionRoughness::samples;

const std::vector<Case> cases = {
    {"default, a mirror", {}},
    {"mirror", {.roughness = mirror, .fallback = ReflectionFallback::environment}},
    {"one layer", {.roughness = mirror, .layers = 1}},
    {"steps of a pixel, unrefined", {.roughness = mirror, .step = 1.0f, .refinement_steps = 0}},
    {"long steps", {.roughness = mirror, .step = 3.75f, .first_step = 1.25f, .refinement_steps = 6}},
    {"few steps", {.roughness = mirror, .max_steps = 4, .fallback = ReflectionFallback::environment}},
    {"thick", {.roughness = mirror, .thickness = 0.7f}},
    {"the paper's, before and behind", {.roughness = mirror, .hit = ReflectionHit::mara2016}},
    {"the paper's, thick, one layer",
     {.roughness = mirror, .layers = 1, .step = 1.0f, .hit = ReflectionHit::mara2016, .thickness = 0.4f}},
    {"between two looks, too", {.roughness = mirror, .hit = ReflectionHit::crossed}},
    {"between two looks, too, one layer, unrefined",
     {.roughness = mirror, .layers = 1, .step = 1.0f, .refinement_steps = 0, .hit = ReflectionHit::crossed}},
    {"short rays", {.roughness = mirror, .max_distance = 0.8f, .fallback = ReflectionFallback::environment}},
    {"backs are hit", {.roughness = mirror, .test_hit_normal = false}},
    {"small bias, no fade", {.roughness = mirror, .bias = 0.001f, .border_fade = 0}},
    {"mip, slightly rough", {.fallback = ReflectionFallback::environment}, 0.2f},
    {"mip, rough", {.layers = 1}, 0.8f},
    {"three samples", {.roughness = samples, .samples = 3, .fallback = ReflectionFallback::environment}, 0.4f},
    {"two samples, rough", {.roughness = samples, .samples = 2}, 1.0f},
};

TEST_P(ReflectionsTest, AgreesWithItsCounterpartOnNoise) {
    const View view = slanted_view(53, 36);
    const counterpart::Layers noise = counterpart::random_layers(view, 4);
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        const counterpart::Gloss gloss = even_gloss(view, {0.9f, 0.5f, 0.2f}, 1.0f, c.roughness);
        const Count count = expect_agreement(context(), noise, gloss, c.settings, reflection_alone, {0.3f, 0.6f, 0.9f});
        EXPECT_LT(count.ambiguous_share(), 0.2);
        EXPECT_GT(count.hits, 100);
        EXPECT_GT(count.second_layer_hits, c.settings.layers == 2 ? 10 : -1);
    }
}

// Every case with cameras and image shapes of its own.
TEST_P(ReflectionsTest, AgreesWithItsCounterpartOnNoiseInRandomViews) {
    unsigned seed = 600;
    for (const Case& c : cases) {
        const RandomView random = random_view(++seed, anywhere, 600);
        SCOPED_TRACE(testing::Message() << c.name << ", " << random);
        const counterpart::Gloss gloss = even_gloss(random.view, {0.9f, 0.5f, 0.2f}, 1.0f, c.roughness);
        const Count count = expect_agreement(context(), counterpart::random_layers(random.view, seed), gloss,
                                             c.settings, reflection_alone, {0.3f, 0.6f, 0.9f});
        EXPECT_LT(count.ambiguous_share(), 0.3);
    }
}

// Everything in the scene reflects, of one roughness.
Scene polished(Scene scene, float roughness) {
    for (Material& material : scene.materials) {
        material.dielectric_reflectance = 0.3f;
        material.roughness = roughness;
    }
    return scene;
}

TEST_P(ReflectionsTest, AgreesWithItsCounterpartInRandomViewsThroughThePipeline) {
    unsigned seed = 700;
    std::size_t turn = 0;
    int hits = 0;
    std::vector<std::string> names = planes_of_layers;
    for (const char* plane : {"reflection", "specular", "roughness", "emission", "layer2.emission"})
        names.emplace_back(plane);
    for (const Scene& matt : {make_cornell(), make_clutter()}) {
        for (const RandomView& random : random_views(seed, 4, bounds_over_time(matt), 800)) {
            const Case& c = cases[(5 * turn++) % cases.size()];
            SCOPED_TRACE(testing::Message() << c.name << ", " << matt.name << ", " << random);
            const Scene scene = polished(matt, c.roughness);
            ReflectionSettings settings = c.settings;
            settings.fallback = ReflectionFallback::none;
            settings.lamps = false;
            Method method = method_of(settings);
            method.radiosity.enabled = false;
            method.direct.shadow.cube_size = method.direct.shadow.emitter_size = 64;
            Quantities quantities{.planes = names};
            quantities.bounces = 1;  // what hits is direct light and emission
            Pipeline pipeline(context(), scene, method, quantities, random.view.width(), random.view.height());
            const Frame frame = pipeline.render(random.view).frame;
            counterpart::Layers layers = layers_of_frame(random.view, frame);
            float brightest = 1.0f;
            for (std::size_t layer = 0; layer < 2; ++layer) {
                auto sum = layers.radiance[layer].values();
                const auto emitted = frame.plane(layer == 0 ? "emission" : "layer2.emission").values();
                for (std::size_t i = 0; i < sum.size(); ++i) brightest = std::max(brightest, sum[i] += emitted[i]);
            }
            const counterpart::Gloss gloss{frame.plane("specular"),
                                           Image(random.view.width(), random.view.height(), 1, 1.0f),
                                           frame.plane("roughness")};
            // As for noise (which is at most 1), relative to the brightest.
            const double tolerance = settings.roughness == samples ? 1e-4 : 1.5e-3;
            const Count count = expect_agreement(layers, gloss, request_of(settings, quantities),
                                                 frame.plane("reflection"), brightest * tolerance);
            EXPECT_LT(count.ambiguous_share(), 0.3);
            hits += count.hits;
        }
        seed += 10;
    }
    EXPECT_GT(hits, 500);
}

TEST_P(ReflectionsTest, AgreesWithItsCounterpartInARoom) {
    const View view = slanted_view(54, 36);
    const counterpart::Layers layers = reflected_room(view);
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        const counterpart::Gloss gloss = even_gloss(view, glm::vec3(0.04f), 1.0f, c.roughness);
        const Count count =
            expect_agreement(context(), layers, gloss, c.settings, reflection_alone, {0.3f, 0.6f, 0.9f});
        EXPECT_LT(count.ambiguous_share(), 0.2);
    }
}

TEST_P(ReflectionsTest, WhatIsReflectedCountsByTheFalloffOfItsDistance) {
    const View view = slanted_view(53, 36);
    const counterpart::Layers noise = counterpart::random_layers(view, 4);
    const counterpart::Gloss gloss = even_gloss(view, glm::vec3(1.0f), 1.0f, 0.0f);
    for (const Falloff falloff : {Falloff::hard, Falloff::quadratic, Falloff::cubic}) {
        SCOPED_TRACE(to_string(falloff));
        Quantities quantities = reflection_alone;
        quantities.reflection_radius = 1.1f;
        quantities.reflection_falloff = falloff;
        const Count count =
            expect_agreement(context(), noise, gloss, {.roughness = mirror}, quantities, {5.0f, 5.0f, 5.0f});
        EXPECT_GT(count.hits, 100);
    }
}

// A level floor that mirrors a wall: each pixel must show the very point of the wall that the mirrored ray meets.
TEST_P(ReflectionsTest, ALevelMirrorShowsTheWallWhereGeometryHasIt) {
    const View view(Camera::look_at("level", {0.0f, 1.0f, 3.0f}, {0.0f, 0.9f, 0.0f}, 0.9f), 160, 120);
    const glm::mat4 camera_from_world = view.camera_from_world();
    const auto patch = [&](const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v) {
        return Patch{glm::vec3(camera_from_world * glm::vec4(corner, 1.0f)), glm::mat3(camera_from_world) * u,
                     glm::mat3(camera_from_world) * v};
    };
    counterpart::Layers layers = layers_of_patches(
        view, {patch({-9, 0, 3}, {18, 0, 0}, {0, 0, -12}), patch({-9, 0, -2}, {18, 0, 0}, {0, 9, 0})});
    // The wall's radiance is its height, so that reflections tell which point they show.
    const glm::mat4 world_from_camera = view.camera().world_from_camera;
    const auto world_point = [&](int x, int y) {
        const glm::dvec3 p = counterpart::point_at(layers, 0, {x, view.height() - 1 - y});
        return glm::vec3(world_from_camera * glm::vec4(glm::vec3(p), 1.0f));
    };
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            const float height = layers.depth[0].at(x, y) == 0.0f ? 0.0f : world_point(x, y).y;
            for (int c = 0; c < 3; ++c) layers.radiance[0].at(x, y, c) = height;
        }
    }
    const counterpart::Gloss gloss = even_gloss(view, glm::vec3(1.0f), 1.0f, 0.0f);
    ReflectionRun run(context(), layers, gloss, method_of({.layers = 1, .step = 3.0f, .border_fade = 0}),
                      reflection_alone);
    const Image reflection = run.render();
    const glm::vec3 eye = view.camera().position();
    int compared = 0;
    double largest = 0.0;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            const glm::vec3 p = world_point(x, y);
            if (layers.depth[0].at(x, y) == 0.0f || p.y > 1e-3f || p.z < -1.99f) continue;
            // Mirrored at y = 0 the ray from the eye goes on to z = -2.
            const float height = eye.y * (p.z + 2.0f) / (eye.z - p.z);
            const glm::vec3 pixel = view.project({p.x + (p.x - eye.x) * (p.z + 2.0f) / (eye.z - p.z), height, -2.0f});
            if (pixel.x < 1.0f || pixel.x > view.width() - 1.0f || pixel.y < 1.0f) continue;
            ++compared;
            largest = std::max(largest, std::abs(static_cast<double>(reflection.at(x, y)) - height));
        }
    }
    EXPECT_GT(compared, 4000);
    // Half a pixel of the wall, 5 m away, is 20 mm high; bilinear reading does better but for the last step's half.
    EXPECT_LT(largest, 0.03);
}

// Of a white environment a lobe reflects its directional albedo, whichever way it is integrated.
TEST_P(ReflectionsTest, AWhiteEnvironmentIsReflectedByTheDirectionalAlbedo) {
    const View view(Camera::look_at("down", {0.0f, 1.0f, 3.0f}, {0.0f, 0.0f, 0.0f}, 0.9f), 24, 16);
    counterpart::Layers layers = layers_of_patches(view, {{{-30, -10, -1}, {60, 0, 0}, {0, 40, -60}}});
    const glm::vec3 f0(0.04f, 0.5f, 1.0f);
    const std::vector<counterpart::Pixel> pixels = {{2, 13}, {12, 7}, {20, 2}};
    for (const float roughness : {0.0f, 0.4f, 1.0f}) {
        const counterpart::Gloss gloss = gloss_at(pixels, even_gloss(view, f0, 1.0f, roughness));
        for (const ReflectionRoughness how : {mirror, mip, samples}) {
            SCOPED_TRACE(testing::Message() << to_string(how) << ", roughness " << roughness);
            ReflectionRun run(
                context(), layers, gloss,
                method_of(
                    {.roughness = how, .samples = 1024, .max_steps = 8, .fallback = ReflectionFallback::environment}),
                reflection_alone, glm::vec3(1.0f));
            const Image reflection = run.render();
            for (const counterpart::Pixel& pixel : pixels) {
                const glm::dvec3 o = -glm::normalize(counterpart::point_at(run.layers(), 0, pixel));
                const double cosine = glm::dot(o, counterpart::vector_at(run.layers(), run.layers().normal[0], pixel));
                const double alpha = ggx_alpha(roughness);
                const glm::dvec2 split = alpha > 0.0 ? integrate_specular_albedo(cosine, alpha, 32)
                                                     : glm::dvec2(1.0 - schlick_weight(cosine), schlick_weight(cosine));
                for (int c = 0; c < 3; ++c) {
                    // The table's bound; a thousand points of a sequence know a smooth integral to 1e-3.
                    EXPECT_NEAR(reflection.at(pixel.x, 15 - pixel.y, c), split.x * f0[c] + split.y,
                                SpecularAlbedo::error_bound);
                }
            }
        }
    }
}

// From below a table, hidden in the first layer by the board in front of it, the floor still reflects the table.
TEST_P(ReflectionsTest, TwoLayersReflectWhatTheFirstOneHides) {
    const View view(Camera::look_at("front", {0.0f, 0.0f, 0.0f}, {0.0f, -0.1f, -1.0f}, 0.9f), 120, 90);
    counterpart::Layers layers = layers_of_patches(view, {{{-6.0f, -1.0f, -9.0f}, {12.0f, 0.0f, 0.0f}, {0, 0, 9.0f}},
                                                          {{-1.0f, -0.9f, -6.0f}, {2.0f, 0, 0}, {0, 1.2f, 0}},
                                                          {{-0.8f, -0.25f, -3.0f}, {1.6f, 0, 0}, {0, 0.5f, 0}}});
    for (int layer = 0; layer < 2; ++layer) {
        for (int y = 0; y < 90; ++y) {
            for (int x = 0; x < 120; ++x) {
                const float depth = layers.depth[layer].at(x, y);
                const bool target = depth > 5.5f && layers.normal[layer].at(x, y, 2) > 0.9f;
                for (int c = 0; c < 3; ++c) layers.radiance[layer].at(x, y, c) = target ? 1.0f : 0.0f;
            }
        }
    }
    const counterpart::Gloss gloss = even_gloss(view, glm::vec3(1.0f), 1.0f, 0.0f);
    const auto brightness = [&](int count) {
        ReflectionRun run(context(), layers, gloss, method_of({.roughness = mirror, .layers = count, .border_fade = 0}),
                          reflection_alone);
        const Image reflection = run.render();
        double sum = 0.0;
        for (const float value : reflection.values()) sum += value;
        return sum / 3.0;
    };
    const double one = brightness(1), two = brightness(2);
    EXPECT_GT(one, 100.0) << "pixels that mirror what is in plain view";
    EXPECT_GT(two, 1.3 * one);
}

// Rays that pass before a board by less than the separation end on it by the paper's rule, and only by that.
TEST_P(ReflectionsTest, ThePapersRuleAlsoHitsWhatARayPassesBefore) {
    const View view = slanted_view(72, 48);
    const counterpart::Layers layers = reflected_room(view);
    const counterpart::Gloss gloss = even_gloss(view, glm::vec3(1.0f), 1.0f, 0.0f);
    const auto hits = [&](ReflectionHit hit) {
        const ReflectionSettings settings{.roughness = mirror, .hit = hit};
        const counterpart::ReflectionTracer tracer(layers, gloss, request_of(settings));
        std::vector<int> found;
        for (int y = 0; y < view.height(); ++y) {
            for (int x = 0; x < view.width(); ++x) found.push_back(tracer.reflect({x, y}).hits);
        }
        return found;
    };
    const std::vector<int> behind = hits(ReflectionHit::behind), either = hits(ReflectionHit::mara2016);
    int gained = 0, lost = 0;
    for (std::size_t i = 0; i < behind.size(); ++i) gained += either[i] > behind[i], lost += either[i] < behind[i];
    EXPECT_GT(gained, 10);
    EXPECT_LT(lost, gained / 2) << "a wider range of depths ends the halving earlier, at times on what cannot be hit";
}

// A floor mirrors a low ceiling whose depth changes by 0.06 to 1 m from row to row, with surfaces 0.1 m thick.
TEST_P(ReflectionsTest, ASlantedCeilingIsReflectedWithoutStripesWhereRaysThatCrossItHitIt) {
    const View view(Camera::look_at("level", {0.0f, 1.0f, 0.0f}, {0.0f, 1.0f, -1.0f}, 0.9f), 96, 144);
    counterpart::Layers layers =
        layers_of_patches(view, {{{-40, -1, 1}, {80, 0, 0}, {0, 0, -13}}, {{-40, 1, 1}, {80, 0, 0}, {0, 0, -13}}});
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            const bool ceiling = layers.normal[0].at(x, y, 1) < 0.0f;
            for (int c = 0; c < 3; ++c) layers.radiance[0].at(x, y, c) = ceiling ? 1.0f : 0.0f;
        }
    }
    const counterpart::Gloss gloss = even_gloss(view, glm::vec3(1.0f), 1.0f, 0.0f);
    // Rows of the floor without a reflection, between two that have one: how many there are down the middle. What lies
    // less than 3.3 m away mirrors what is less than 9.9 m away, well before the ceiling ends.
    const auto stripes = [&](ReflectionHit hit) {
        ReflectionRun run(context(), layers, gloss,
                          method_of({.roughness = mirror, .layers = 1, .hit = hit, .border_fade = 0}),
                          reflection_alone);
        const Image reflection = run.render();
        int dark = 0, lost = 0, bright = 0;
        for (int y = view.height() - 1; y > view.height() / 2; --y) {
            if (layers.depth[0].at(48, y) > 3.3f || layers.depth[0].at(48, y) == 0.0f) continue;
            const bool found = reflection.at(48, y) > 0.5f;
            if (found && bright++ > 0) lost += dark;
            dark = found ? 0 : dark + 1;
        }
        EXPECT_GT(bright, 8);
        return lost;
    };
    EXPECT_GT(stripes(ReflectionHit::behind), 3);
    EXPECT_EQ(stripes(ReflectionHit::crossed), 0);
}

TEST_P(ReflectionsTest, HitsFadeTowardsTheBorder) {
    const View view = slanted_view(72, 48);
    const counterpart::Layers layers = reflected_room(view);
    const counterpart::Gloss gloss = even_gloss(view, glm::vec3(1.0f), 1.0f, 0.0f);
    const glm::vec3 sky(7.0f);
    const auto render = [&](int fade) {
        return ReflectionRun(
                   context(), layers, gloss,
                   method_of({.roughness = mirror, .border_fade = fade, .fallback = ReflectionFallback::environment}),
                   reflection_alone, sky)
            .render();
    };
    const Image sharp = render(0), faded = render(12);
    int between = 0, at_all = 0;
    for (std::size_t i = 0; i < sharp.values().size(); i += 3) {
        const float before = sharp.values()[i], after = faded.values()[i];
        ASSERT_GE(after, before - 1e-4f) << "towards the brighter sky";
        ASSERT_LE(after, 7.0f + 1e-4f);
        at_all += before < 6.9f;
        between += after > before + 1e-3f && after < 6.9f;
    }
    EXPECT_GT(between, 40);
    EXPECT_LT(between, at_all / 2);
}

TEST_P(ReflectionsTest, TheRadianceChainIsAveragedOverSurfacesOnly) {
    const View view = slanted_view(61, 35);
    const counterpart::Layers noise = counterpart::random_layers(view, 9);
    ReflectionRun run(context(), noise, even_gloss(view, glm::vec3(1.0f), 1.0f, 0.5f), method_of({}), reflection_alone);
    run.render();
    for (int layer = 0; layer < 2; ++layer) {
        const Image level = run.render(radiance_chain_plane, 4, layer, 3);
        ASSERT_EQ(level.width(), 7);
        ASSERT_EQ(level.height(), 4);
        glm::dvec4 expected(0.0);
        for (int y = 8; y < 16; ++y) {
            for (int x = 24; x < 32; ++x) {
                if (counterpart::depth_at(noise, layer, {x, y}) == 0.0) continue;
                expected += glm::dvec4(counterpart::vector_at(noise, noise.radiance[layer], {x, y}), 1.0) / 64.0;
            }
        }
        // Half floats, rounded at four levels.
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(level.at(3, 4 - 1 - 1, c), expected[c], 1.5e-3);
    }
}

TEST_P(ReflectionsTest, ParametersOutOfRangeAreErrors) {
    const View view = slanted_view(32, 24);
    const counterpart::Layers noise = counterpart::random_layers(view, 4);
    const counterpart::Gloss gloss = even_gloss(view, glm::vec3(1.0f), 1.0f, 0.0f);
    const auto expect_error = [&](const ReflectionSettings& settings, const char* name) {
        try {
            ReflectionRun run(context(), noise, gloss, method_of(settings), reflection_alone);
            ADD_FAILURE() << name;
        } catch (const MethodError& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr(name));
        }
    };
    expect_error({.samples = 0}, "reflections.samples is 0");
    expect_error({.step = 0.0f}, "reflections.step is 0");
    expect_error({.max_steps = 0}, "reflections.max_steps is 0");
    expect_error({.refinement_steps = 40}, "reflections.refinement_steps is 40");
    expect_error({.thickness = -1.0f}, "reflections.thickness is -1");
    expect_error({.max_distance = 0.0f}, "reflections.max_distance is 0");
    expect_error({.bias = -0.5f}, "reflections.bias is -0.5");
    expect_error({.border_fade = -3}, "reflections.border_fade is -3");
}

}  // namespace
}  // namespace plumb

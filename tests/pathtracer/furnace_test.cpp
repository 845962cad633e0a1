// An enclosure that emits and reflects alike everywhere: the radiance is known after any number of bounces.
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/pathtracer/test_scenes.h"

namespace plumb {
namespace {

Scene furnace(float albedo, float emission, const glm::mat4& world_from_object) {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(albedo), glm::vec3(emission)), room_quads(), world_from_object);
    return scene;
}

class Furnace : public testing::TestWithParam<float> {};

// Each order k of the Neumann series is albedo^(k + 1) Le, wherever one looks.
TEST_P(Furnace, EveryBounceHoldsItsTermOfTheGeometricSeries) {
    const float albedo = GetParam(), emission = 2.0f;
    constexpr int bounces = 4;
    // Rotated, stretched, mirrored and off the origin: nothing may depend on alignment or winding.
    glm::mat4 transform = glm::translate(glm::mat4(1.0f), glm::vec3(3.0f, -7.0f, 11.0f));
    transform = glm::rotate(transform, 0.7f, glm::normalize(glm::vec3(1.0f, 2.0f, 3.0f)));
    transform = glm::scale(transform, glm::vec3(1.0f, 1.5f, -2.0f));
    const Scene scene = furnace(albedo, emission, transform);
    const glm::vec3 eye(transform * glm::vec4(0.1f, 0.2f, 0.3f, 1.0f)), target(transform * glm::vec4(1, 0.9f, -1, 1));
    const auto settings = settings_for({"emission", "direct", "indirect", "indirect.1", "indirect.2", "indirect.3",
                                        "indirect.4", "irradiance", "total"},
                                       256, bounces);
    const Frame frame = PathTracer(scene).render(view_of(eye, target, 1.5f), settings).frame;

    double sum = 0.0, power = emission;
    for (const float value : frame.plane("emission").values()) ASSERT_EQ(value, emission);
    for (int k = 0; k <= bounces; ++k) {
        power *= albedo;
        if (k > 0) sum += power;
        const std::string plane = k == 0 ? "direct" : fmt::format("indirect.{}", k);
        expect_mean(frame, plane, power);
    }
    expect_mean(frame, "indirect", sum);
    expect_mean(frame, "total", emission + emission * albedo + sum);
    // Where the albedo is 0 the irradiance after one bounce is 0 as well: nothing reflects.
    expect_mean(frame, "irradiance", albedo > 0.0f ? glm::pi<double>() * sum / albedo : 0.0);
}

INSTANTIATE_TEST_SUITE_P(Albedos, Furnace, testing::Values(0.0f, 0.5f, 0.9f, 0.99f));

// With every wall's light the same, what a radius and a falloff leave of the indirect light is what they take of the
// openness: indirect.k = albedo^(k + 1) Le (1 - ao), since only the first segment is limited, and the irradiance pi
// (albedo + albedo^2) Le (1 - ao). All look along the same rays, so that there is no noise between them.
TEST(FurnaceByDirections, IndirectLightCountsByDistanceAsOccludersDo) {
    const float albedo = 0.5f;
    const Scene scene = furnace(albedo, 1.0f, glm::mat4(1.0f));
    const PathTracer tracer(scene);
    for (const Falloff falloff : {Falloff::hard, Falloff::quadratic, Falloff::cubic}) {
        for (const float radius : {0.7f, 1.5f, 10.0f}) {
            auto settings = settings_for({"ao", "indirect.1", "indirect.2", "irradiance"}, 16, 2);
            settings.emitter_sampling = EmitterSampling::directions;
            settings.quantities.ao_radius = settings.quantities.indirect_radius = radius;
            settings.quantities.ao_falloff = settings.quantities.indirect_falloff = falloff;
            const Frame frame = tracer.render(view_of({0, 0, 0}, {0.4f, -1, 0.3f}, 1.5f), settings).frame;
            for (int x = 0; x < frame.width(); ++x) {
                const std::string what = fmt::format("{} within {}", to_string(falloff), radius);
                const double near = 1.0 - frame.plane("ao").at(x, 7);
                // 1e-6: a few roundings of float32 products.
                EXPECT_NEAR(frame.plane("indirect.1").at(x, 7, 1), std::pow(albedo, 2) * near, 1e-6) << what;
                EXPECT_NEAR(frame.plane("indirect.2").at(x, 7, 1), std::pow(albedo, 3) * near, 1e-6) << what;
                const double irradiance = glm::pi<double>() * (albedo + std::pow(albedo, 2)) * near;
                EXPECT_NEAR(frame.plane("irradiance").at(x, 7, 1), irradiance, 1e-6 * irradiance + 1e-6) << what;
            }
        }
    }
}

// The same identity where points on the walls are sampled as well. The openness is that of a run of its own, whose
// noise, at 64 times as many samples, counts for nothing.
TEST(FurnaceByBoth, IndirectLightCountsByDistanceAsOccludersDo) {
    const float albedo = 0.5f;
    const Scene scene = furnace(albedo, 1.0f, glm::mat4(1.0f));
    const PathTracer tracer(scene);
    const View view = view_of({0, 0, 0}, {0.4f, -1, 0.3f}, 1.5f);
    for (const Falloff falloff : {Falloff::hard, Falloff::quadratic, Falloff::cubic}) {
        for (const float radius : {0.7f, 1.5f, 10.0f}) {
            auto settings = settings_for({"ao"}, 8192);
            settings.quantities.ao_radius = settings.quantities.indirect_radius = radius;
            settings.quantities.ao_falloff = settings.quantities.indirect_falloff = falloff;
            const Frame openness = tracer.render(view, settings).frame;
            settings.quantities.planes = {"indirect.1", "indirect.2"}, settings.quantities.bounces = 2;
            settings.samples = 1024, settings.seed = 2;
            const Frame frame = tracer.render(view, settings).frame;
            for (const int k : {1, 2}) {
                expect_mean(
                    frame, fmt::format("indirect.{}", k),
                    [&](int x, int y) { return std::pow(albedo, k + 1) * (1.0 - openness.plane("ao").at(x, y)); },
                    fmt::format("{} within {}", to_string(falloff), radius), 1e-3, 0.03);
            }
        }
    }
}

// Following rays to the walls, every ray finds the same radiance: there is nothing random left.
TEST(FurnaceByDirections, IsFreeOfNoise) {
    const Scene scene = furnace(0.5f, 1.0f, glm::mat4(1.0f));
    auto settings = settings_for({"direct", "indirect.1", "indirect.2"}, 16, 2);
    settings.emitter_sampling = EmitterSampling::directions;
    const Frame frame = PathTracer(scene).render(view_of({0, 0, 0}, {0.4f, -1, 0.3f}, 1.5f), settings).frame;
    // 1e-6: a few roundings of float32 products; any leak through an edge would cost whole samples.
    for (const float value : frame.plane("direct").values()) EXPECT_NEAR(value, 0.5f, 1e-6f);
    for (const float value : frame.plane("indirect.1").values()) EXPECT_NEAR(value, 0.25f, 1e-6f);
    for (const float value : frame.plane("indirect.2").values()) EXPECT_NEAR(value, 0.125f, 1e-6f);
}

// Bounces after which less than 1e-6 is left to come.
int bounces_to_the_limit(float albedo) {
    return albedo > 0.0f ? static_cast<int>(std::ceil(std::log(1e-6) / std::log(static_cast<double>(albedo)))) : 0;
}

// After K bounces the total is Le (1 - albedo^(K + 2)) / (1 - albedo): emission, direct light and K orders more; after
// enough of them it is Le / (1 - albedo). By every way of sampling; with roulette, whose chance is then the only noise
// where rays find the emitters, and without.
class FurnaceLimit : public testing::TestWithParam<std::tuple<float, EmitterSampling, int>> {
protected:
    // Points on lights alone are too noisy where walls meet at an angle: nearby points count without bound. In a ball
    // every point of the wall counts the same, and the facets of one with 8192 are nearly in its surface.
    static Scene scene(float albedo, float emission, EmitterSampling sampling) {
        if (sampling != EmitterSampling::lights) return furnace(albedo, emission, glm::mat4(1.0f));
        Scene scene;
        add_smooth_ball(scene, add_material(scene, glm::vec3(albedo), glm::vec3(emission)), 5);
        scene.meshes[0].normals.clear();
        return scene;
    }
};

TEST_P(FurnaceLimit, IsEmissionOverOneMinusAlbedo) {
    const auto [albedo, sampling, roulette_after] = GetParam();
    constexpr float emission = 2.0f;
    const Scene walls = scene(albedo, emission, sampling);
    const PathTracer tracer(walls);
    const View view = view_of({0, 0, 0}, {0.4f, -1, 0.3f}, 1.5f, 8);
    const double limit = emission / (1.0 - static_cast<double>(albedo));
    for (const int bounces : {0, 8, bounces_to_the_limit(albedo)}) {
        const bool reaches_limit = bounces == bounces_to_the_limit(albedo);
        for (const bool antialias : {false, true}) {
            const std::string what = fmt::format("{} bounces{}", bounces, antialias ? ", antialiased" : "");
            // Each vertex of a path without roulette is a sample of its own: long paths need to be few.
            auto settings = settings_for({"total"}, roulette_after == 0 && bounces > 100 ? 16 : 128, bounces);
            settings.emitter_sampling = sampling;
            settings.roulette_after = roulette_after;
            settings.antialias = antialias;
            const Frame frame = tracer.render(view, settings).frame;
            const double expected =
                reaches_limit ? limit : limit * (1.0 - std::pow(static_cast<double>(albedo), bounces + 2));
            // 4e-5: the roundings of products and sums of float32, of which some hundred count. Roulette is noisy where
            // nothing is absorbed for long: 5 % must be seen then, else 1 %.
            expect_mean(frame, "total", expected, what, 4e-5, roulette_after > 0 && albedo > 0.8f ? 0.05 : 0.01);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, FurnaceLimit,
                         testing::Combine(testing::Values(0.0f, 0.5f, 0.9f, 0.99f),
                                          testing::Values(EmitterSampling::directions, EmitterSampling::both,
                                                          EmitterSampling::lights),
                                          testing::Values(0, 2)));

// A perfect mirror (metal of base colour 1, for which Schlick's term is 1 at every angle) in a box that emits Le and
// reflects nothing else: its `reflection` is Le from the box at once. Where the box itself is a mirror that emits, each
// further bounce finds Le again: (K + 1) Le.
TEST(Furnace, OfMirrorsAddsOneEmissionPerBounce) {
    Scene scene = furnace(1.0f, 1.5f, glm::mat4(1.0f));
    scene.materials[0].metallic = 1.0f, scene.materials[0].roughness = 0.0f;
    const PathTracer tracer(scene);
    for (const int bounces : {0, 1, 5}) {
        for (const EmitterSampling sampling :
             {EmitterSampling::lights, EmitterSampling::directions, EmitterSampling::both}) {
            auto settings = settings_for({"direct", "indirect", "reflection", "total"}, 8, bounces);
            settings.emitter_sampling = sampling;
            const Frame frame = tracer.render(view_of({0, 0, 0}, {0.4f, -1, 0.3f}, 1.5f, 8), settings).frame;
            const float expected = 1.5f * static_cast<float>(bounces + 1);
            for (const float value : frame.plane("direct").values()) EXPECT_EQ(value, 0.0f);
            for (const float value : frame.plane("indirect").values()) EXPECT_EQ(value, 0.0f);
            // 1e-5: a few roundings per bounce.
            for (const float value : frame.plane("reflection").values()) EXPECT_NEAR(value, expected, 1e-5f * expected);
            for (const float value : frame.plane("total").values())
                EXPECT_NEAR(value, expected + 1.5f, 1e-5f * expected);
        }
    }
}

// In the middle of a wall of the cube |x| <= 1 the side walls are 1 m away and the opposite one 2 m. A hard radius r
// leaves four caps of directions with sine above 1 / r, disjoint for r < sqrt(2); cosine-weighted, each is a segment of
// the unit disc.
TEST(Furnace, IndirectRadiusKeepsOnlyTheNearSurfaces) {
    const Scene scene = furnace(0.5f, 1.0f, glm::mat4(1.0f));
    const View view = view_of({0, 0.5f, 0}, {0, -1, 0}, 1e-3f, 16, {0, 0, 1});
    auto settings = settings_for({"indirect", "irradiance"}, 1024, 1);
    const PathTracer tracer(scene);

    settings.quantities.indirect_radius = 0.99f;
    const Frame nothing = tracer.render(view, settings).frame;
    for (const float value : nothing.plane("indirect").values()) EXPECT_EQ(value, 0.0f);

    settings.quantities.indirect_radius = 1.3f;
    const double c = 1.0 / 1.3;
    const double share = 4.0 * (std::acos(c) - c * std::sqrt(1.0 - c * c)) / glm::pi<double>();
    const Frame limited = tracer.render(view, settings).frame;
    expect_mean(limited, "indirect", 0.25 * share);
    expect_mean(limited, "irradiance", 0.5 * glm::pi<double>() * share);

    settings.quantities.indirect_radius = 10.0f;  // beyond everything
    expect_mean(tracer.render(view, settings).frame, "indirect", 0.25);
}

}  // namespace
}  // namespace plumb

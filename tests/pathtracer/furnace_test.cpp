// An enclosure that emits and reflects alike everywhere: the radiance is known after any number of bounces.
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

TEST(Furnace, MoreBouncesApproachEmissionOverOneMinusAlbedo) {
    const Scene scene = furnace(0.5f, 1.0f, glm::mat4(1.0f));
    auto settings = settings_for({"total"}, 16, 20);
    settings.emitter_sampling = EmitterSampling::directions;
    settings.roulette_after = 0;  // chance would be the only noise
    const Frame frame = PathTracer(scene).render(view_of({0, 0, 0}, {0.4f, -1, 0.3f}, 1.5f), settings).frame;
    // Le / (1 - albedo) = 2; what is cut off after 20 bounces is 2 * 0.5^22 = 5e-7.
    for (const float value : frame.plane("total").values()) EXPECT_NEAR(value, 2.0f, 1e-5f);
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

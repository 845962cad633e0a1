// Light adds up and scales: lights with each other, planes to the total, everything with the emission.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/pathtracer/lit_room.h"

namespace plumb {
namespace {

const std::vector<std::string> all_planes = {"emission",   "direct",     "indirect",   "indirect.1", "indirect.2",
                                             "indirect.3", "irradiance", "reflection", "total"};

// Lights without extent are summed one by one at the first point. 4e-7: three roundings of float32.
TEST(Superposition, OfLightsWithoutExtentIsExact) {
    const auto direct = [](const Lit& lit) {
        return PathTracer(lit_room(lit)).render(room_view(), settings_for({"direct"}, 2)).frame.plane("direct");
    };
    const Image all = direct({.point = true, .spot = true, .sun = true}), point = direct({.point = true}),
                spot = direct({.spot = true}), sun = direct({.sun = true});
    double brightest = 0.0;
    for (std::size_t i = 0; i < all.values().size(); ++i) {
        const double sum = static_cast<double>(point.values()[i]) + spot.values()[i] + sun.values()[i];
        EXPECT_NEAR(all.values()[i], sum, 4e-7 * sum) << "value " << i;
        brightest = std::max(brightest, sum);
    }
    EXPECT_GT(brightest, 0.1);
}

TEST(Superposition, OfAllKindsOfLightHoldsOnAverage) { expect_superposition({"direct", "reflection"}, 0, 4096); }

// At the outline of a coarse smooth ball the interpolated normal leans away from the viewer, and the specular lobe
// stands about another one: it sees lamps beside the viewer that the surface's normal does not, also as one of several.
// A lamp alone comes out without noise.
TEST(Superposition, OfLampsThatOnlyTheLobeSees) {
    const View view = view_of({0, 0, 1.3f}, {0.6f, 0.2f, 0.2f}, 0.12f, 8);
    const std::vector<PointLight> lamps = {{"low", {0.2f, 0.0f, 1.4f}, glm::vec3(4, 3, 2)},
                                           {"high", {0.0f, 0.3f, 1.5f}, glm::vec3(2, 3, 4)}};
    const auto reflection = [&](const std::vector<PointLight>& lights, std::uint64_t seed) {
        Scene scene;
        add_smooth_ball(scene, add_material(scene, glm::vec3(0.9f)), 0);
        scene.materials[0].metallic = 1.0f, scene.materials[0].roughness = 0.9f;
        scene.point_lights = lights;
        auto settings = settings_for({"reflection"}, 1024, 1);
        settings.seed = seed;
        return PathTracer(scene).render(view, settings).frame.plane("reflection");
    };
    Replicates together, summed;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        together.add(reflection(lamps, seed));
        Image sum = reflection({lamps[0]}, 100 + seed);
        const Image other = reflection({lamps[1]}, 200 + seed);
        for (std::size_t i = 0; i < sum.values().size(); ++i) sum.values()[i] += other.values()[i];
        summed.add(sum);
    }
    EXPECT_GT(summed.mean(summed.size() - 3), 0.01) << "the lobe should see the lamps";
    // Where one lamp gives less than a thousandth, it may not be among those that were picked.
    expect_agreement(together, summed, "two lamps beside the viewer", 2e-3);
}

struct LinearityCase {
    bool antialias;
    Sky sky;
};
class LinearityInEmission : public testing::TestWithParam<LinearityCase> {};

Frame at_brightness(float brightness, const LinearityCase& with) {
    Lit lit = everything;
    lit.brightness = brightness, lit.sky = with.sky;
    const Scene scene = lit_room(lit, 0.1f);
    auto settings = settings_for(all_planes, 16, 3);
    settings.antialias = with.antialias;
    return PathTracer(scene).render(room_view(), settings).frame;
}

// Powers of two only move exponents: no decision along any path, no rounding may change.
TEST_P(LinearityInEmission, IsExactForPowersOfTwo) {
    const Frame once = at_brightness(1.0f, GetParam());
    for (const float factor : {0.25f, 2.0f, 1024.0f}) {
        const Frame scaled = at_brightness(factor, GetParam());
        for (const std::string& plane : once.plane_names()) {
            const auto from = once.plane(plane).values(), to = scaled.plane(plane).values();
            const float power = is_derived_plane(plane) && plane.starts_with("variance.") ? factor * factor : factor;
            std::size_t different = 0;
            for (std::size_t i = 0; i < from.size(); ++i) different += to[i] == power * from[i] ? 0 : 1;
            EXPECT_EQ(different, 0u) << plane << " of " << from.size() << " values, factor " << factor;
        }
    }
}

// Other factors round. A random choice may then turn out the other way, but only where its random number lies within a
// rounding of the edge, 1e-7 of all: not in the few thousand choices here. 1e-5: some tens of roundings of float32, and
// samples rounded to the accumulation's quantum, against the brightest value.
TEST_P(LinearityInEmission, HoldsWithinRoundingForOtherFactors) {
    const Frame once = at_brightness(1.0f, GetParam());
    for (const float factor : {3.0f, 0.7f}) {
        const Frame scaled = at_brightness(factor, GetParam());
        for (const std::string& plane : all_planes) {
            const auto from = once.plane(plane).values(), to = scaled.plane(plane).values();
            const float brightest = *std::max_element(to.begin(), to.end());
            for (std::size_t i = 0; i < from.size(); ++i) {
                EXPECT_NEAR(to[i], factor * from[i], 1e-5f * factor * from[i] + 1e-6f * brightest) << plane << " " << i;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, LinearityInEmission,
                         testing::Values(LinearityCase{false, Sky::constant}, LinearityCase{true, Sky::constant},
                                         LinearityCase{false, Sky::image}, LinearityCase{true, Sky::image}),
                         [](const auto& test) {
                             return fmt::format("{}Under{}Sky",
                                                test.param.antialias ? "Antialiased" : "ThroughPixelCentres",
                                                test.param.sky == Sky::image ? "AnImage" : "AConstant");
                         });

// The total of both halves and of the mean is ((emission + direct) + indirect) + reflection, and the indirect light the
// sum of its bounces from the first on, added in float: whoever adds the planes up gets the very bits.
void expect_exact_sums(const Frame& frame, int bounces) {
    for (const std::string half : {"half_a.", "half_b.", ""}) {
        const auto values = [&](const std::string& plane) {
            // Through pixel centres the emission is the same for all samples and has no halves.
            return frame.plane(frame.has(half + plane) ? half + plane : plane).values();
        };
        std::size_t wrong_totals = 0, wrong_sums = 0;
        for (std::size_t i = 0; i < values("total").size(); ++i) {
            float total = values("emission")[i] + values("direct")[i];
            total += values("indirect")[i];
            total += values("reflection")[i];
            wrong_totals += values("total")[i] == total ? 0 : 1;
            float sum = values("indirect.1")[i];
            for (int k = 2; k <= bounces; ++k) sum += values(fmt::format("indirect.{}", k))[i];
            wrong_sums += values("indirect")[i] == sum ? 0 : 1;
        }
        EXPECT_EQ(wrong_totals, 0u) << half << "total";
        EXPECT_EQ(wrong_sums, 0u) << half << "indirect";
    }
}

TEST(Total, IsExactlyTheSumOfItsPlanes) {
    const Scene scene = lit_room(everything, 0.1f);
    for (const bool antialias : {false, true}) {
        auto settings = settings_for(all_planes, 16, 3);
        settings.antialias = antialias;
        const Frame frame = PathTracer(scene).render(room_view(), settings).frame;
        expect_exact_sums(frame, 3);
        std::size_t lit = 0;
        for (std::size_t i = 0; i < frame.plane("total").values().size(); ++i) {
            lit += frame.plane("indirect.3").values()[i] > 0.0f && frame.plane("reflection").values()[i] > 0.0f ? 1 : 0;
        }
        EXPECT_GT(lit, 100u);
    }
}

// The same of a room that glows and has no gloss, where the parts are of like size.
TEST(Total, IsTheSumAlsoWhereEverythingGlows) {
    Scene scene;
    add_quads(scene, add_material(scene, {0.7f, 0.5f, 0.3f}, {0.2f, 0.1f, 0.05f}), room_quads());
    scene.point_lights.push_back({"lamp", {0.1f, 0.2f, 0.3f}, {1, 2, 3}});
    const View view = view_of({0, 0, 0}, {0, -1, 0.4f}, 1.5f);
    expect_exact_sums(PathTracer(scene).render(view, settings_for(all_planes, 8, 3)).frame, 3);
}

}  // namespace
}  // namespace plumb

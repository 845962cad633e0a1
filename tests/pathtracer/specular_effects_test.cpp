// What mirrors, rough metals and glossy dielectrics show, and suns with a disc.
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "tests/pathtracer/closed_forms.h"
#include "tests/pathtracer/effects_scenes.h"
#include "tests/pathtracer/estimator_comparisons.h"

namespace plumb {
namespace {

using closed_form::pi;

const glm::dvec3 up(0.0, 1.0, 0.0);
const glm::vec3 copper(0.95f, 0.6f, 0.4f);

// A mirror y = 0 seen from above, at 30 to 60 degrees.
Scene mirror_scene() {
    Scene scene;
    add_quads(scene, add_metal(scene, copper, 0.0f), {floor_quad(10.0f)});
    return scene;
}
View mirror_view(int size = 16) { return view_of({0.0f, 1.0f, 1.0f}, {0.0f, 0.0f, 0.0f}, 0.5f, size); }

ReferenceSettings settings_by(EmitterSampling strategy, std::vector<std::string> planes, int samples, int bounces) {
    ReferenceSettings settings = settings_for(std::move(planes), samples, bounces);
    settings.emitter_sampling = strategy;
    return settings;
}

class BySampling : public testing::TestWithParam<EmitterSampling> {};

TEST_P(BySampling, AMirrorShowsAnEmitterTimesFresnelWithoutNoise) {
    Scene scene = mirror_scene();
    const glm::vec3 emission(2.0f, 3.0f, 5.0f);
    // A ceiling that only some of the mirrored rays meet.
    add_quads(scene, add_material(scene, glm::vec3(0.0f), emission),
              {{{-0.31f, 2, -3}, {1, 2, -3}, {1, 2, -1.6f}, {-0.31f, 2, -1.6f}}});
    const View view = mirror_view();
    const Frame frame = PathTracer(scene).render(view, settings_by(GetParam(), {"reflection", "direct"}, 8, 2)).frame;
    const auto expected = [&](int x, int y) {
        const PixelRay mirrored = PixelRay(view, x, y).mirrored(up, 0.0);
        const glm::dvec3 seen = mirrored.on_plane(up, 2.0);
        const bool met = seen.x > -0.31 && seen.x < 1.0 && seen.z > -3.0 && seen.z < -1.6;
        return met ? fresnel_of_metal(copper, mirrored.direction.y) * glm::dvec3(emission) : glm::dvec3(0.0);
    };
    const int lit = expect_exactly(frame, "reflection", expected);
    EXPECT_GT(lit, 50);
    EXPECT_LT(lit, 200);
    expect_exactly(
        frame, "direct", [](int, int) { return glm::dvec3(0.0); }, "a metal has no diffuse lobe");
}

TEST_P(BySampling, AMirrorShowsTheEnvironmentAndTheSunsDisc) {
    Scene scene = mirror_scene();
    scene.environment.radiance = {0.5f, 0.6f, 0.7f};
    const View view = mirror_view(32);
    constexpr double radius = 0.1;
    const glm::dvec3 to_sun = glm::normalize(glm::dvec3(0.05, 1.0, -0.9));
    const glm::vec3 irradiance(2.0f, 1.5f, 1.0f);
    scene.directional_lights.push_back({"sun", glm::vec3(-to_sun), irradiance, static_cast<float>(radius)});
    // The disc's irradiance where it is faced is radiance * pi sin^2(radius).
    const glm::dvec3 disc = glm::dvec3(irradiance) / (pi * std::pow(std::sin(radius), 2.0));
    const Frame frame = PathTracer(scene).render(view, settings_by(GetParam(), {"reflection"}, 4, 1)).frame;
    int inside = 0, outside = 0;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const PixelRay mirrored = PixelRay(view, x, y).mirrored(up, 0.0);
            const double angle = std::acos(glm::dot(mirrored.direction, to_sun));
            if (std::abs(angle - radius) < 1e-5) continue;  // the rounding of a direction to float32
            const bool hit = angle < radius;
            ++(hit ? inside : outside);
            const glm::dvec3 light = glm::dvec3(scene.environment.radiance) + (hit ? disc : glm::dvec3(0.0));
            const glm::dvec3 expected = fresnel_of_metal(copper, mirrored.direction.y) * light;
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(frame.plane("reflection").at(x, y, c), expected[c], 2e-6 * expected[c]) << x << ", " << y;
            }
        }
    }
    EXPECT_GT(inside, 50);
    EXPECT_GT(outside, 50);
}

TEST_P(BySampling, ASunOfAnyRadiusLightsATiltedSurfaceByTheCosine) {
    const glm::vec3 to_sun = glm::normalize(glm::vec3(0.2f, 1.0f, 0.1f));
    // Directions alone find small discs rarely: the lobe's density times the disc's solid angle.
    const std::vector<float> radii =
        GetParam() == EmitterSampling::directions ? std::vector<float>{0.5f} : std::vector<float>{0.00465f, 0.1f, 0.5f};
    for (const float radius : radii) {
        for (const float tilt : {0.0f, 0.4f, 0.8f}) {
            Scene scene;
            const glm::vec3 along(std::cos(tilt), std::sin(tilt), 0.0f), across(0.0f, 0.0f, 1.0f);
            add_quads(scene, add_material(scene, glm::vec3(0.5f)),
                      {{across - along, across + along, along - across, -along - across}});
            scene.directional_lights.push_back({"sun", -to_sun, glm::vec3(2.0f), radius});
            const glm::vec3 normal(-std::sin(tilt), std::cos(tilt), 0.0f);
            const double cosine = glm::dot(normal, to_sun);
            ASSERT_GT(cosine, std::sin(radius)) << "the disc must be above the horizon";
            const Frame frame = PathTracer(scene)
                                    .render(view_of(4.0f * normal, {0, 0, 0}, 0.1f, 8, {0, 0, 1}),
                                            settings_by(GetParam(), {"direct"}, 2048, 0))
                                    .frame;
            // The disc's vector irradiance points along its axis, as long as all of it is above the horizon. The
            // tolerance is that of cap_height and sin in float for the smallest.
            expect_mean(frame, "direct", 0.5 / pi * 2.0 * cosine, "radius " + std::to_string(radius), 1e-5);
        }
    }
}

// A mirror under a glowing ceiling: what it shows counts by how far away it lies, and the sky behind not at all.
TEST_P(BySampling, WhatAMirrorShowsCountsByItsDistance) {
    Scene scene = mirror_scene();
    scene.environment.radiance = glm::vec3(7.0f);
    add_quads(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(2.0f)),
              {{{-0.31f, 2, -30}, {1, 2, -30}, {1, 2, 30}, {-0.31f, 2, 30}}});
    const View view = mirror_view();
    const PathTracer tracer(scene);
    for (const Falloff falloff : {Falloff::hard, Falloff::quadratic, Falloff::cubic}) {
        auto settings = settings_by(GetParam(), {"reflection"}, 4, 1);
        settings.quantities.reflection_radius = 2.8f;
        settings.quantities.reflection_falloff = falloff;
        const auto expected = [&](int x, int y) {
            const PixelRay mirrored = PixelRay(view, x, y).mirrored(up, 0.0);
            const glm::dvec3 seen = mirrored.on_plane(up, 2.0);
            const double distance = 2.0 / mirrored.direction.y, ratio = distance / 2.8;
            if (seen.x < -0.31 || seen.x > 1.0 || ratio >= 1.0) return glm::dvec3(0.0);
            const double exponent = falloff == Falloff::hard ? 0.0 : falloff == Falloff::quadratic ? 1.0 : 3.0;
            return fresnel_of_metal(copper, mirrored.direction.y) * 2.0 * std::pow(1.0 - ratio * ratio, exponent);
        };
        const Frame frame = tracer.render(view, settings).frame;
        int lit = 0;
        for (int y = 0; y < frame.height(); ++y) {
            for (int x = 0; x < frame.width(); ++x) {
                const glm::dvec3 wanted = expected(x, y);
                lit += wanted.x > 0.0 ? 1 : 0;
                for (int c = 0; c < 3; ++c) {
                    // 2e-6: a few roundings of numbers up to 2, cubed; near the radius what is left is far smaller.
                    EXPECT_NEAR(frame.plane("reflection").at(x, y, c), wanted[c], 2e-6)
                        << to_string(falloff) << " at " << x << ", " << y;
                }
            }
        }
        EXPECT_GT(lit, 20) << to_string(falloff);
        EXPECT_LT(lit, 200) << to_string(falloff);
    }
}

INSTANTIATE_TEST_SUITE_P(All, BySampling, testing::ValuesIn(all_strategies),
                         [](const auto& test) { return name_of(test.param); });

TEST(Mirror, ShowsALitWallWithoutNoise) {
    Scene scene = mirror_scene();
    const glm::dvec3 light(0.4, 1.0, 0.5), intensity(3.0, 2.0, 1.0);
    add_quads(scene, add_material(scene, {0.3f, 0.5f, 0.7f}),
              {{{-20, 0, -2}, {20, 0, -2}, {20, 20, -2}, {-20, 20, -2}}});
    scene.point_lights.push_back({"lamp", glm::vec3(light), glm::vec3(intensity)});
    const View view = mirror_view();
    const Frame frame = PathTracer(scene).render(view, settings_for({"reflection"}, 8, 1)).frame;
    const glm::dvec3 forward(0.0, 0.0, 1.0);
    const int lit = expect_exactly(
        frame, "reflection",
        [&](int x, int y) {
            const PixelRay mirrored = PixelRay(view, x, y).mirrored(up, 0.0);
            const glm::dvec3 offset = light - mirrored.on_plane(forward, -2.0);
            const double squared = glm::dot(offset, offset), cosine = offset.z / std::sqrt(squared);
            const glm::dvec3 wall = glm::dvec3(glm::vec3(0.3f, 0.5f, 0.7f)) / pi * intensity * (cosine / squared);
            return fresnel_of_metal(copper, mirrored.direction.y) * wall;
        },
        "lit wall", 1e-5);
    EXPECT_EQ(lit, 256);
}

// The lobe's directional albedo by the midpoint rule over incident directions, from the textbook's formulas: GGX
// distribution (Walter et al. 2007), height-correlated Smith term (Heitz 2014), Schlick's Fresnel term.
double rough_albedo(double f0, double cosine_o, double alpha) {
    constexpr int rings = 600, spokes = 600;
    const double sine_o = std::sqrt(1.0 - cosine_o * cosine_o), a2 = alpha * alpha;
    const auto lambda = [&](double cosine) {
        return 0.5 * (std::sqrt(1.0 + a2 * (1.0 / (cosine * cosine) - 1.0)) - 1.0);
    };
    double sum = 0.0;
    for (int i = 0; i < rings; ++i) {
        const double cosine_i = (i + 0.5) / rings, sine_i = std::sqrt(1.0 - cosine_i * cosine_i);
        for (int j = 0; j < spokes; ++j) {
            const double phi = pi * (j + 0.5) / spokes;  // the other half is its mirror image
            const glm::dvec3 wo(sine_o, 0.0, cosine_o), wi(sine_i * std::cos(phi), sine_i * std::sin(phi), cosine_i);
            const glm::dvec3 h = glm::normalize(wo + wi);
            const double t = h.z * h.z * (a2 - 1.0) + 1.0, distribution = a2 / (pi * t * t);
            const double masking = 1.0 / (1.0 + lambda(cosine_o) + lambda(cosine_i));
            const double fresnel = f0 + (1.0 - f0) * std::pow(1.0 - glm::dot(wo, h), 5.0);
            sum += fresnel * distribution * masking / (4.0 * cosine_o * cosine_i) * cosine_i;
        }
    }
    return sum * 2.0 * pi / rings / spokes;
}

// A narrow view, so that all pixels see the surface from much the same angle: over half a hundredth of a radian E
// changes by less than 0.1 %.
View narrow_view(double cosine) {
    const auto c = static_cast<float>(cosine), s = std::sqrt(1.0f - c * c);
    return view_of({0.0f, 2.0f * c, 2.0f * s}, {0, 0, 0}, 0.005f, 8, {0, 1, -1});
}
constexpr double view_tolerance = 1e-3;

TEST(RoughMetal, UnderAConstantEnvironmentShowsItsDirectionalAlbedo) {
    for (const float roughness : {0.4f, 0.7f, 1.0f}) {
        for (const double cosine : {0.95, 0.5, 0.25}) {
            Scene scene;
            add_quads(scene, add_metal(scene, glm::vec3(0.6f), roughness), {floor_quad(10.0f)});
            scene.environment.radiance = glm::vec3(1.5f);
            const Frame frame =
                PathTracer(scene).render(narrow_view(cosine), settings_for({"reflection"}, 1024, 1)).frame;
            const double alpha = static_cast<double>(roughness) * roughness;
            expect_mean(frame, "reflection", 1.5 * rough_albedo(0.6f, cosine, alpha),
                        "roughness " + std::to_string(roughness), view_tolerance);
        }
    }
}

// What the specular lobe takes is what the diffuse one lacks: a surface that absorbs nothing shows what surrounds it.
// The path tracer's table of directional albedos may be off by its bound.
TEST(Dielectric, ReflectsAllThatItGetsWhereItsAlbedoIsOne) {
    for (const float roughness : {0.0f, 0.3f, 0.6f, 1.0f}) {
        for (const double cosine : {0.95, 0.5, 0.25}) {
            Scene scene;
            add_quads(scene, add_dielectric(scene, glm::vec3(1.0f), roughness), {floor_quad(10.0f)});
            scene.environment.radiance = glm::vec3(1.5f);
            const Frame frame =
                PathTracer(scene)
                    .render(narrow_view(cosine), settings_for({"direct", "reflection", "total"}, 1024, 1))
                    .frame;
            const std::string what = "roughness " + std::to_string(roughness) + ", cosine " + std::to_string(cosine);
            const bool mirror = roughness == 0.0f;
            expect_mean(frame, "total", 1.5, what, mirror ? 0.0 : SpecularAlbedo::error_bound);
            const double alpha = static_cast<double>(roughness) * roughness;
            const double reflected =
                mirror ? 0.04 + 0.96 * std::pow(1.0 - cosine, 5.0) : rough_albedo(0.04, cosine, alpha);
            expect_mean(frame, "reflection", 1.5 * reflected, what, 2.0 * view_tolerance);
            const double bound = mirror ? 0.0 : SpecularAlbedo::error_bound;
            expect_mean(frame, "direct", 1.5 * (1.0 - reflected), what, view_tolerance + bound / (1.0 - reflected));
        }
    }
}

// A closed room whose walls glow with radiance 1 and absorb nothing: each further bounce adds exactly 1 to every
// direction, whatever the lobes. `total` is 1 (emission) + 1 (one segment) + 1 for each of K bounces.
TEST(GlossyRoom, ThatAbsorbsNothingAddsOneEmissionPerBounce) {
    constexpr int bounces = 4;
    for (const float roughness : {0.0f, 0.35f, 0.8f}) {
        for (const EmitterSampling strategy : {EmitterSampling::directions, EmitterSampling::both}) {
            Scene scene;
            const int walls = add_dielectric(scene, glm::vec3(1.0f), roughness, 0.2f);
            scene.materials.back().emission = glm::vec3(1.0f);
            add_quads(scene, walls, room_quads());
            auto settings = settings_by(strategy, {"total", "indirect.1", "indirect.4"}, 512, bounces);
            const Frame frame =
                PathTracer(scene).render(view_of({0.1f, 0.2f, 0.3f}, {1, -0.9f, -0.8f}, 1.0f, 8), settings).frame;
            const double bound = roughness == 0.0f ? 0.0 : SpecularAlbedo::error_bound;
            const std::string what = "roughness " + std::to_string(roughness) + ", " + name_of(strategy);
            // The table's bound alone, taken at every bounce, comes near 1 %.
            expect_mean(frame, "total", 2.0 + bounces, what, bound * (bounces + 1) / 2.0, 0.02);
            // Of radiance 1 x's diffuse lobe reflects 1 - E, which is what `indirect.k` has for every k.
            double first = 0.0, last = 0.0;
            for (const float value : frame.plane("indirect.1").values()) first += value;
            for (const float value : frame.plane("indirect.4").values()) last += value;
            EXPECT_NEAR(last / first, 1.0, 0.01 + 3.0 * bound) << what;
        }
    }
}

// Everything at once for the strategies to disagree about: a glossy floor, a rough metal, a panel, an image, a sun;
// none of them so small or so near that noise would hide 1 %.
Setting glossy_scene() {
    Scene scene;
    add_quads(scene, add_dielectric(scene, {0.5f, 0.4f, 0.3f}, 0.6f, 0.2f), {floor_quad(4.0f)});
    add_quads(scene, add_metal(scene, copper, 0.7f), {{{-4, 0, -1.5f}, {4, 0, -1.5f}, {4, 4, -1.5f}, {-4, 4, -1.5f}}});
    add_quads(scene, add_material(scene, glm::vec3(0.2f), glm::vec3(6.0f)),
              {{{3, 1, -2}, {3, 1, 2}, {2, 3, 2}, {2, 3, -2}}});
    add_uneven_sky(scene);
    scene.directional_lights.push_back({"sun", glm::normalize(glm::vec3(0.4f, -1, -0.5f)), glm::vec3(3.0f), 0.6f});
    return {"GlossyScene", std::move(scene), view_of({-0.5f, 2.0f, 1.0f}, {0, 0, -1.0f}, 0.15f, 2)};
}

// Bounces of such scenes are compared in estimators_agree_slow_test.cpp.
TEST(GlossyScene, LooksTheSameHoweverItsLightIsFound) {
    const Comparison comparison{glossy_scene(), {}, {}, {"direct", "reflection"}, 0, 32768, 10};
    const auto both = replicates(comparison, by(EmitterSampling::both), 3000);
    for (const EmitterSampling strategy : {EmitterSampling::lights, EmitterSampling::directions}) {
        const auto alone = replicates(comparison, by(strategy), strategy == EmitterSampling::lights ? 1000 : 2000);
        for (const std::string& plane : comparison.planes) {
            expect_agreement(alone.at(plane), both.at(plane), name_of(strategy) + " against both, " + plane);
        }
    }
}

// Light samples and followed rays count alike by their distance.
TEST(GlossyScene, LooksTheSameWithinARadiusHoweverItsLightIsFound) {
    const Comparison comparison{glossy_scene(), {}, {}, {"reflection"}, 0, 16384, 10};
    const auto within = [](EmitterSampling strategy) {
        return Way{name_of(strategy), [=](ReferenceSettings& settings) {
                       settings.emitter_sampling = strategy;
                       settings.quantities.reflection_radius = 5.0f;
                       settings.quantities.reflection_falloff = Falloff::quadratic;
                   }};
    };
    const auto both = replicates(comparison, within(EmitterSampling::both), 3000);
    for (const EmitterSampling strategy : {EmitterSampling::lights, EmitterSampling::directions}) {
        const auto alone = replicates(comparison, within(strategy), strategy == EmitterSampling::lights ? 1000 : 2000);
        expect_agreement(alone.at("reflection"), both.at("reflection"),
                         name_of(strategy) + " against both within a radius");
    }
}

}  // namespace
}  // namespace plumb

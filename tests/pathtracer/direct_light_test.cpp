// Direct light against closed forms, light by light.
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "tests/bright_sky.h"
#include "tests/pathtracer/closed_forms.h"
#include "tests/pathtracer/test_scenes.h"

namespace plumb {
namespace {

constexpr float floor_albedo = 0.6f;

// A floor of 20 m, seen obliquely.
Scene floor_scene() {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(floor_albedo)), {floor_quad(10.0f)});
    return scene;
}
View floor_view(int size = 16) { return view_of({0.0f, 2.0f, 3.0f}, {0.2f, 0.0f, 0.1f}, 0.6f, size); }

// Every pixel of `direct` is the function of its position on the floor. 2e-5 relative: float32 positions and products.
void expect_everywhere(const Scene& scene, const std::function<double(const glm::dvec3&)>& expected) {
    const Frame frame = PathTracer(scene).render(floor_view(), settings_for({"direct", "position"}, 2)).frame;
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            const double value = expected(glm::dvec3(colour_at(frame.plane("position"), x, y)));
            EXPECT_NEAR(frame.plane("direct").at(x, y), value, 2e-5 * value + 1e-7) << "pixel " << x << ", " << y;
        }
    }
}

TEST(PointLight, FallsOffWithTheSquareOfTheDistance) {
    Scene scene = floor_scene();
    const glm::dvec3 position(0.3, 1.5, -0.4);
    scene.point_lights.push_back({"lamp", glm::vec3(position), glm::vec3(5.0f)});
    expect_everywhere(scene, [&](const glm::dvec3& p) {
        const glm::dvec3 offset = position - p;
        const double distance = glm::length(offset);
        return floor_albedo / glm::pi<double>() * 5.0 * (offset.y / distance) / (distance * distance);
    });
}

TEST(SpotLight, FadesBetweenItsTwoAngles) {
    Scene scene = floor_scene();
    const glm::dvec3 position(0.0, 2.0, 0.0), axis = glm::normalize(glm::dvec3(0.1, -1.0, 0.05));
    scene.spot_lights.push_back({"spot", glm::vec3(position), glm::vec3(axis), glm::vec3(7.0f), 0.1f, 0.35f});
    const double inner = std::cos(0.1), outer = std::cos(0.35);
    expect_everywhere(scene, [&](const glm::dvec3& p) {
        const glm::dvec3 offset = position - p;
        const double distance = glm::length(offset);
        const double t = glm::clamp((glm::dot(axis, -offset / distance) - outer) / (inner - outer), 0.0, 1.0);
        return floor_albedo / glm::pi<double>() * 7.0 * t * t * (offset.y / distance) / (distance * distance);
    });
}

// The three terms of OGLdev's model, one by one and together, 1.5 to 4 m from the lamp; a cone changes nothing of it.
TEST(Attenuation, OfPointAndSpotLightsFollowsItsTerms) {
    const glm::dvec3 position(0.3, 1.5, -0.4), axis = glm::normalize(glm::dvec3(0.1, -1.0, 0.2));
    const float inner = 0.5f, outer = 0.8f;
    for (const Attenuation attenuation :
         {Attenuation{2.0f, 0.0f, 0.0f}, Attenuation{0.0f, 1.5f, 0.0f}, Attenuation{1.0f, 0.7f, 1.8f}}) {
        const auto arrives = [&](const glm::dvec3& p) {
            const glm::dvec3 offset = position - p;
            const double distance = glm::length(offset);
            return floor_albedo / glm::pi<double>() * 5.0 * (offset.y / distance) /
                   (attenuation.constant + attenuation.linear * distance + attenuation.quadratic * distance * distance);
        };
        Scene with_point = floor_scene(), with_spot = floor_scene();
        with_point.point_lights.push_back({"lamp", glm::vec3(position), glm::vec3(5.0f), attenuation});
        expect_everywhere(with_point, arrives);
        with_spot.spot_lights.push_back(
            {"spot", glm::vec3(position), glm::vec3(axis), glm::vec3(5.0f), inner, outer, attenuation});
        expect_everywhere(with_spot, [&](const glm::dvec3& p) {
            const double cosine = glm::dot(axis, glm::normalize(p - position)), from = std::cos(inner),
                         to = std::cos(outer);
            const double t = glm::clamp((cosine - to) / (from - to), 0.0, 1.0);
            return t * t * arrives(p);
        });
    }
}

TEST(DirectionalLight, IsTheSameEverywhere) {
    Scene scene = floor_scene();
    const glm::vec3 direction = glm::normalize(glm::vec3(1.0f, -2.0f, 0.5f));
    scene.directional_lights.push_back({"sun", direction, glm::vec3(3.0f)});
    expect_everywhere(scene, [&](const glm::dvec3&) { return floor_albedo / glm::pi<double>() * 3.0 * -direction.y; });
}

TEST(DirectionalLight, ComesNotThroughASurface) {
    Scene scene = floor_scene();
    add_quads(scene, 0, {floor_quad(10.0f, 5.0f)});
    scene.directional_lights.push_back({"sun", {0.0f, -1.0f, 0.0f}, glm::vec3(3.0f)});
    expect_everywhere(scene, [](const glm::dvec3&) { return 0.0; });
}

class EmitterStrategies : public testing::TestWithParam<EmitterSampling> {};

TEST_P(EmitterStrategies, ManySmallTexturedEmittersAddUp) {
    Scene scene = floor_scene();
    const int emitter = add_material(scene, glm::vec3(0.0f), glm::vec3(6.0f));
    // Bright in one texel of 4 x 4, dim in the others: 1/16 * 1 + 15/16 * 0.1 on average.
    Texture texture;
    texture.width = texture.height = 4;
    for (int i = 0; i < 16; ++i) {
        const half value = i == 5 ? 1.0f : 0.1f;
        texture.texels.insert(texture.texels.end(), {value, value, value, half(1.0f)});
    }
    scene.textures.push_back(texture);
    scene.materials[emitter].emission_texture = 0;
    std::vector<std::vector<glm::vec3>> quads;
    for (int i = 0; i < 20; ++i) {
        for (int j = 0; j < 20; ++j) {
            const float x = 0.1f * static_cast<float>(i) - 1.0f, z = 0.1f * static_cast<float>(j) - 1.0f;
            quads.push_back({{x, 1.5f, z}, {x + 0.1f, 1.5f, z}, {x + 0.1f, 1.5f, z + 0.1f}, {x, 1.5f, z + 0.1f}});
        }
    }
    add_quads(scene, emitter, quads);
    auto settings = settings_for({"direct", "position"}, 4096);
    settings.emitter_sampling = GetParam();
    const View view = view_of({0.0f, 0.8f, 3.0f}, {0.0f, 0.0f, 0.0f}, 0.4f);
    const Frame frame = PathTracer(scene).render(view, settings).frame;
    // Tiles of 0.1 m at 1.5 m: the tiling's mean radiance to within (0.1 / 1.5)^2 / 12 = 4e-4 of its variation.
    const double radiance = 6.0 * (1.0 / 16.0 + 15.0 / 16.0 * 0.1);
    expect_mean(frame, "direct", [&](int x, int y) {
        const glm::dvec3 position(colour_at(frame.plane("position"), x, y));
        return floor_albedo / glm::pi<double>() * radiance *
               closed_form::polygon_irradiance(position, {0, 1, 0},
                                               {{-1, 1.5, -1}, {1, 1.5, -1}, {1, 1.5, 1}, {-1, 1.5, 1}});
    });
}

TEST_P(EmitterStrategies, ConstantEnvironmentOverAnOpenPlaneIsAlbedoTimesRadiance) {
    Scene scene = floor_scene();
    scene.environment.radiance = glm::vec3(1.5f);
    auto settings = settings_for({"direct", "emission", "indirect"}, 8);
    settings.emitter_sampling = GetParam();
    const Frame frame = PathTracer(scene).render(view_of({0, 2, 3}, {0, 1, 0}, 1.2f), settings).frame;
    const Image& direct = frame.plane("direct");
    const Frame gbuffer = PathTracer(scene).gbuffer(view_of({0, 2, 3}, {0, 1, 0}, 1.2f), {.layers = 1});
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            const bool sky = std::isinf(gbuffer.plane("depth").at(x, y));
            EXPECT_NEAR(direct.at(x, y), sky ? 0.0f : floor_albedo * 1.5f, 1e-5f);
            EXPECT_EQ(frame.plane("emission").at(x, y), sky ? 1.5f : 0.0f);
            EXPECT_EQ(frame.plane("indirect").at(x, y), 0.0f);  // a plane alone does not light itself
        }
    }
}

// The integral of L cos(theta) over the upper hemisphere, midpoint rule; errs by less than 1e-4 at this step.
double irradiance_of_sky(const Scene& scene) {
    double integral = 0.0;
    constexpr int steps = 1000;
    for (int j = 0; j < steps; ++j) {
        const double theta = glm::half_pi<double>() * (j + 0.5) / steps;
        for (int i = 0; i < steps; ++i) {
            const double phi = glm::two_pi<double>() * (i + 0.5) / steps;
            const glm::vec3 direction(std::sin(theta) * std::cos(phi), std::cos(theta),
                                      std::sin(theta) * std::sin(phi));
            integral += scene.environment_radiance(direction).x * std::cos(theta) * std::sin(theta);
        }
    }
    return integral * glm::half_pi<double>() / steps * glm::two_pi<double>() / steps;
}

TEST_P(EmitterStrategies, ImageEnvironmentMatchesItsNumericIntegral) {
    Scene scene = floor_scene();
    Texture sky;
    sky.width = 32, sky.height = 16, sky.wrap_v = TextureWrap::clamp;
    for (int j = 0; j < 16; ++j) {
        for (int i = 0; i < 32; ++i) {
            const float bright =
                i == 20 && j == 4 ? 40.0f : 0.2f + 0.02f * static_cast<float>(i % 7) + 0.05f * static_cast<float>(j);
            sky.texels.insert(sky.texels.end(), {half(bright), half(0.5f * bright), half(2.0f * bright), half(1.0f)});
        }
    }
    scene.textures.push_back(sky);
    scene.environment = {glm::vec3(0.7f), 0, 0.9f};
    auto settings = settings_for({"direct"}, 1024);
    settings.emitter_sampling = GetParam();
    const Frame frame = PathTracer(scene).render(floor_view(), settings).frame;

    expect_mean(frame, "direct", floor_albedo / glm::pi<double>() * irradiance_of_sky(scene), "", 0.0, 0.01,
                {1.0, 0.5, 2.0});
}

INSTANTIATE_TEST_SUITE_P(All, EmitterStrategies,
                         testing::Values(EmitterSampling::lights, EmitterSampling::directions, EmitterSampling::both));

// Nothing cuts a sun of a million: neither what the floor gets from it nor what the camera sees of it, antialiased or
// not; and the sums of its samples stay exact.
TEST(ImageEnvironment, ASunBrighterThanHalfFloatsKeepsAllItsLight) {
    const Scene scene = floor_below_bright_sky("exr");
    const double expected = 0.5 / glm::pi<double>() * irradiance_of_sky(scene);
    EXPECT_GT(expected, 1e3);  // the sun's: the clear sky gives 0.1
    const PathTracer tracer(scene);
    const glm::vec3 eye(0.0f, 2.0f, 0.0f);
    const View sun_view = view_of(eye, eye + sun_direction(scene), 1e-3f, 4);
    for (const EmitterSampling sampling : {EmitterSampling::lights, EmitterSampling::both}) {
        auto settings = settings_for({"direct"}, 1024);
        settings.emitter_sampling = sampling;
        expect_mean(tracer.render(floor_view(), settings).frame, "direct", expected);
    }
    for (const bool antialias : {false, true}) {
        auto settings = settings_for({"emission"}, 64);
        settings.antialias = antialias;
        const ReferenceResult seen = tracer.render(sun_view, settings);
        EXPECT_TRUE(seen.exact);
        // 1 %: the view spans a thousandth of a radian, 0.3 % of the texel, over which the sun fades as a tent.
        for (const float value : seen.frame.plane("emission").values())
            EXPECT_NEAR(value, sun_radiance, 0.01f * sun_radiance);
    }
}

TEST(OneSidedSurface, IsBlackOnItsBack) {
    for (const bool from_behind : {false, true}) {
        Scene scene;
        add_quads(scene, add_material(scene, glm::vec3(floor_albedo), glm::vec3(1.0f), false), {floor_quad(10.0f)});
        scene.environment.radiance = glm::vec3(1.0f);
        const float side = from_behind ? -1.0f : 1.0f;
        const auto settings = settings_for({"emission", "direct", "albedo"}, 8);
        const Frame frame = PathTracer(scene).render(view_of({0, 2.0f * side, 1}, {0, 0, 0}), settings).frame;
        for (const float value : frame.plane("emission").values()) EXPECT_EQ(value, from_behind ? 0.0f : 1.0f);
        for (const float value : frame.plane("albedo").values()) EXPECT_EQ(value, from_behind ? 0.0f : floor_albedo);
        for (const float value : frame.plane("direct").values())
            EXPECT_NEAR(value, from_behind ? 0.0f : floor_albedo, 1e-5f);
    }
}

TEST(OneSidedEmitter, DoesNotLightWhatIsBehindIt) {
    Scene scene = floor_scene();
    // Seen from above counter-clockwise: it emits upwards, away from the floor.
    add_quads(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(4.0f), false), {floor_quad(0.5f, 1.0f)});
    const Frame frame = PathTracer(scene).render(view_of({0, 0.5f, 2}, {0, 0, 0}), settings_for({"direct"}, 16)).frame;
    for (const float value : frame.plane("direct").values()) EXPECT_EQ(value, 0.0f);
}

TEST(AlphaMask, LetsLightThroughItsHoles) {
    Scene scene = floor_scene();
    const int mask = add_material(scene, glm::vec3(0.5f));
    Texture texture;
    texture.width = 2, texture.height = 1, texture.wrap_u = texture.wrap_v = TextureWrap::clamp;
    texture.texels = {half(1.0f), half(1.0f), half(1.0f), half(0.0f), half(1.0f), half(1.0f), half(1.0f), half(1.0f)};
    scene.textures.push_back(texture);
    scene.materials[mask].base_colour_texture = 0;
    scene.materials[mask].alpha_mask = true;
    add_quads(scene, mask, {floor_quad(2.0f, 1.0f)});  // u grows with x: a hole for x < 0
    scene.directional_lights.push_back({"sun", {0.0f, -1.0f, 0.0f}, glm::vec3(1.0f)});
    const Frame frame = PathTracer(scene)
                            .render(view_of({0, 0.5f, 1.5f}, {0, 0, 0}, 0.2f), settings_for({"direct", "position"}, 2))
                            .frame;
    int lit = 0, dark = 0;
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            const bool hole = frame.plane("position").at(x, y, 0) < 0.0f;
            EXPECT_NEAR(frame.plane("direct").at(x, y), hole ? floor_albedo / glm::pi<float>() : 0.0f, 1e-6f);
            ++(hole ? lit : dark);
        }
    }
    EXPECT_GT(lit, 50);
    EXPECT_GT(dark, 50);
}

}  // namespace
}  // namespace plumb

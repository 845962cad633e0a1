// A camera inside a diffuse sphere, whose radiance is known for every light, however it is found.
//
// Any two points of a sphere of radius R see each other by the same kernel, cos cos' / (pi d^2) = 1 / (4 pi R^2), so
// that a bounce makes the irradiance even whatever it was: it is the mean radiosity of the sphere, times the share of
// the sphere that there is. In a whole sphere each bounce multiplies by the albedo; in the lower half by half the
// albedo.
//   Source: the idea is pbrt-v4's, cpu/integrators_test.cpp; the kernel is that of the integrating sphere.
//
// The spheres are polyhedra here, which are nearly as good: each bounce in a closed polyhedron is an average with
// weights that sum to 1, so that it lies between the least and the greatest of what it averages.
#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "scenes/ggx.h"
#include "tests/pathtracer/closed_forms.h"
#include "tests/pathtracer/effects_scenes.h"

namespace plumb {
namespace {

using closed_form::pi;

constexpr float albedo = 0.5f;

// 128 x 256 facets of a unit sphere. Facets are tilted from the sphere by up to t = pi / 256 * sqrt(2) = 0.017 and lie
// up to 1 - cos(t) = 1.5e-4 inside: what falls off with distance squared is up to 3e-4 too bright in a facet's middle
// and 1.5e-4 too dark at its corners. Uneven light adds the tilt times its unevenness, of both signs within each facet,
// which averages out over the hundred facets in view to below 0.017 / sqrt(100) / 2.
constexpr int rings = 128;
constexpr double facet_error = 5e-4, uneven_facet_error = 1.5e-3;

// The part of a sphere with y from -radius up to `top` (in rings from below), as seen from within.
Mesh sphere(double radius, int material, bool smooth, int top = rings, int detail = rings) {
    Mesh mesh;
    mesh.material = material;
    const auto columns = static_cast<unsigned>(2 * detail);
    for (int i = 0; i <= top; ++i) {
        const double theta = pi * i / detail;
        for (unsigned j = 0; j < columns; ++j) {
            const double phi = 2.0 * pi * j / columns;
            const glm::dvec3 out(std::sin(theta) * std::cos(phi), -std::cos(theta), std::sin(theta) * std::sin(phi));
            mesh.positions.emplace_back(radius * out);
            if (smooth) mesh.normals.emplace_back(-out);
        }
    }
    for (unsigned i = 0; i < static_cast<unsigned>(top); ++i) {
        for (unsigned j = 0; j < columns; ++j) {
            const unsigned next = (j + 1) % columns, below = i * columns, above = below + columns;
            // At the poles one of the two is but a line.
            if (i > 0) mesh.triangles.push_back({below + j, below + next, above + next});
            if (i + 1 < static_cast<unsigned>(detail)) {
                mesh.triangles.push_back({below + j, above + next, above + j});
            }
        }
    }
    return mesh;
}

void add_mesh(Scene& scene, Mesh mesh) {
    scene.instances.push_back({"sphere", static_cast<int>(scene.meshes.size())});
    scene.meshes.push_back(std::move(mesh));
}

struct Enclosure {
    std::string name;
    std::function<void(Scene&, bool smooth)> build;
    double emission = 0.0;    // of the sphere itself
    double indirect = 0.0;    // indirect.1, everywhere
    double per_bounce = 0.0;  // what each further bounce multiplies by
    double direct = -1.0;     // negative: not the same everywhere, but
    std::function<double(const glm::dvec3& position)> direct_at = {};
    bool uneven = false;  // the light before the first bounce
    int samples = 64;     // per pixel, enough for the test's power
};

void add_sphere(Scene& scene, bool smooth, int top = rings, float emission = 0.0f) {
    add_mesh(scene, sphere(1.0, add_material(scene, glm::vec3(albedo), glm::vec3(emission)), smooth, top));
}

Enclosure point_at_centre() {
    return {.name = "PointAtCentre",
            .build =
                [](Scene& scene, bool smooth) {
                    add_sphere(scene, smooth);
                    scene.point_lights.push_back({"lamp", glm::vec3(0.0f), glm::vec3(2.0f)});
                },
            .indirect = albedo * albedo * 2.0 / pi,
            .per_bounce = albedo,
            .direct = albedo * 2.0 / pi};
}

// A lamp away from the centre, at distances of 0.6 to 1.4, with all terms of an attenuation. At the angle t from its
// side the sphere is at distance d, d^2 = 1 + a^2 - 2 a cos(t), and faces it at the cosine (1 - a cos(t)) / d.
Enclosure attenuated_lamp() {
    constexpr double aside = 0.4, intensity = 4.0;
    constexpr Attenuation attenuation{0.5f, 0.6f, 0.8f};
    const auto irradiance = [=](double cosine_t) {
        const double d = std::sqrt(1.0 + aside * aside - 2.0 * aside * cosine_t);
        return intensity * (1.0 - aside * cosine_t) / d /
               (attenuation.constant + attenuation.linear * d + attenuation.quadratic * d * d);
    };
    // The mean over the sphere: caps between equal steps of the cosine have equal areas.
    const double mean = 0.5 * closed_form::integrate(irradiance, -1.0, 1.0);
    return {
        .name = "AttenuatedLamp",
        .build =
            [=](Scene& scene, bool smooth) {
                add_sphere(scene, smooth);
                const glm::vec3 position(0.0f, 0.0f, static_cast<float>(aside));
                scene.point_lights.push_back({"lamp", position, glm::vec3(static_cast<float>(intensity)), attenuation});
            },
        .indirect = albedo / pi * albedo * mean,
        .per_bounce = albedo,
        .direct_at = [=](const glm::dvec3& position) { return albedo / pi * irradiance(position.z); },
        .uneven = true};
}

// The flux of a spot light: full within the inner angle, then the square of a ramp in the cosine, whose mean is 1/3.
Enclosure spot_at_centre() {
    constexpr float inner = 0.4f, outer = 1.1f, intensity = 6.0f;
    const double from = std::cos(inner), to = std::cos(outer);
    const double flux = 2.0 * pi * intensity * ((1.0 - from) + (from - to) / 3.0);
    return {.name = "SpotAtCentre",
            .build =
                [](Scene& scene, bool smooth) {
                    add_sphere(scene, smooth);
                    SpotLight spot{"spot", glm::vec3(0.0f), {0.8f, -0.6f, 0.0f}, glm::vec3(intensity), inner, outer};
                    scene.spot_lights.push_back(spot);
                },
            .indirect = albedo / pi * albedo * flux / (4.0 * pi),
            .per_bounce = albedo,
            .direct_at =
                [=](const glm::dvec3& position) {
                    const double cosine = glm::dot(position, {0.8, -0.6, 0.0});
                    const double t = glm::clamp((cosine - to) / (from - to), 0.0, 1.0);
                    return albedo / pi * intensity * t * t;
                },
            .uneven = true,
            .samples = 256};
}

Enclosure emissive_sphere() {
    return {.name = "EmissiveSphere",
            .build = [](Scene& scene, bool smooth) { add_sphere(scene, smooth, rings, 1.5f); },
            .emission = 1.5,
            .indirect = albedo * albedo * 1.5,
            .per_bounce = albedo,
            .direct = albedo * 1.5};
}

// The light is the upper half of the sphere, itself as diffuse as the rest.
Enclosure emissive_half() {
    return {.name = "EmissiveHalf",
            .build =
                [](Scene& scene, bool smooth) {
                    add_sphere(scene, smooth, rings / 2);
                    Mesh upper =
                        sphere(1.0, add_material(scene, glm::vec3(albedo), glm::vec3(3.0f)), smooth, rings / 2);
                    for (glm::vec3& position : upper.positions) position.y = -position.y;
                    for (glm::vec3& normal : upper.normals) normal.y = -normal.y;
                    for (glm::uvec3& triangle : upper.triangles) std::swap(triangle.y, triangle.z);
                    add_mesh(scene, std::move(upper));
                },
            .indirect = albedo * albedo * 3.0 / 2.0,
            .per_bounce = albedo,
            .direct = albedo * 3.0 / 2.0,
            .uneven = true,
            .samples = 224};
}

// A black glowing ball in the middle covers the share r^2 of what each point of the sphere sees, cosine-weighted.
Enclosure glowing_ball() {
    constexpr double radius = 0.3, share = radius * radius;
    return {.name = "GlowingBall",
            .build =
                [](Scene& scene, bool smooth) {
                    add_sphere(scene, smooth);
                    const int glowing = add_material(scene, glm::vec3(0.0f), glm::vec3(20.0f));
                    add_mesh(scene, sphere(radius, glowing, false, 64, 64));
                },
            .indirect = albedo * (1.0 - share) * albedo * 20.0 * share,
            .per_bounce = albedo * (1.0 - share),
            .direct = albedo * 20.0 * share,
            .samples = 640};
}

// Parallel light falls into a bowl, the lower half of the sphere: pi E arrives, spread over 2 pi square metres.
Enclosure sun_in_bowl() {
    return {.name = "SunInBowl",
            .build =
                [](Scene& scene, bool smooth) {
                    add_sphere(scene, smooth, rings / 2);
                    scene.directional_lights.push_back({"sun", {0.0f, -1.0f, 0.0f}, glm::vec3(4.0f)});
                },
            .indirect = albedo / pi * albedo * 4.0 * pi / (4.0 * pi),
            .per_bounce = albedo / 2.0,
            .direct_at = [](const glm::dvec3& position) { return albedo / pi * 4.0 * -position.y; },
            .uneven = true,
            .samples = 256};
}

// The same flux from a sun with a disc, whose directions spread by 34 degrees.
Enclosure broad_sun_in_bowl() {
    return {.name = "BroadSunInBowl",
            .build =
                [](Scene& scene, bool smooth) {
                    add_sphere(scene, smooth, rings / 2);
                    scene.directional_lights.push_back({"sun", {0.0f, -1.0f, 0.0f}, glm::vec3(4.0f), 0.6f});
                },
            .indirect = albedo / pi * albedo * 4.0 * pi / (4.0 * pi),
            .per_bounce = albedo / 2.0,
            .uneven = true,
            .samples = 1280};
}

// Of the sky each point of the bowl sees the half that the bowl leaves open.
Enclosure sky_over_bowl() {
    return {.name = "SkyOverBowl",
            .build =
                [](Scene& scene, bool smooth) {
                    add_sphere(scene, smooth, rings / 2);
                    scene.environment.radiance = glm::vec3(2.0f);
                },
            .indirect = albedo * 0.5 * albedo * 2.0 * 0.5,
            .per_bounce = albedo / 2.0,
            .direct = albedo * 2.0 * 0.5,
            .samples = 256};
}

// All that passes the bowl's opening, pi times the sky's irradiance, arrives in the bowl.
Enclosure image_over_bowl() {
    Scene sky;
    add_uneven_sky(sky);
    constexpr int steps = 500;  // midpoint rule over 32 x 8 bilinear texels: errs by less than 1e-4
    constexpr double cell = pi * pi / (steps * steps);
    double irradiance = 0.0;
    for (int i = 0; i < steps * steps; ++i) {
        const int row = i / steps, column = i % steps;
        const double theta = 0.5 * pi * (row + 0.5) / steps, phi = 2.0 * pi * (column + 0.5) / steps;
        const glm::vec3 direction(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
        irradiance += sky.environment_radiance(direction).x * std::cos(theta) * std::sin(theta) * cell;
    }
    return {.name = "ImageOverBowl",
            .build =
                [](Scene& scene, bool smooth) {
                    add_sphere(scene, smooth, rings / 2);
                    add_uneven_sky(scene);
                },
            .indirect = albedo / pi * albedo * irradiance * pi / (4.0 * pi),
            .per_bounce = albedo / 2.0,
            .uneven = true,
            .samples = 1024};
}

// A way to render: what must not matter. Adding one is one line.
struct Way {
    const char* name;
    std::function<void(ReferenceSettings&, View&)> choose;
    bool with_smooth_normals = false;  // as well as with face normals
    double times_power = 1.0;          // where it is noisier than the others
};

// Independent points have up to three times the variance of the others.
constexpr double power_of_random_points = 5.0 / 3.0;

// Sharp at a distance in the middle of what is seen; blurred within a facet or two.
View with_lens(const View& view) {
    Camera camera = view.camera();
    camera.aperture_radius = 0.02f, camera.focus_distance = 0.4f;
    return View(camera, view.width(), view.height());
}
// All that a view from outside holds, which is everything.
OracleSettings all_in_view() { return {view_of({0, 0, 6}, {0, 0, 0}), 0, 0.1f}; }

const std::vector<Way> ways = {
    {"Lights", [](auto& settings, View&) { settings.emitter_sampling = EmitterSampling::lights; }},
    {"Directions", [](auto& settings, View&) { settings.emitter_sampling = EmitterSampling::directions; }},
    {"Both", [](auto& settings, View&) { settings.emitter_sampling = EmitterSampling::both; }, true},
    {"LightsAntialiased",
     [](auto& settings, View&) { settings.emitter_sampling = EmitterSampling::lights, settings.antialias = true; }},
    {"DirectionsAntialiased",
     [](auto& settings, View&) { settings.emitter_sampling = EmitterSampling::directions, settings.antialias = true; }},
    {"BothAntialiased",
     [](auto& settings, View&) { settings.emitter_sampling = EmitterSampling::both, settings.antialias = true; }},
    {"RandomPoints", [](auto& settings, View&) { settings.points = SamplePoints::random; }, false,
     power_of_random_points},
    {"RandomPointsOnLights",
     [](auto& settings, View&) {
         settings.points = SamplePoints::random, settings.emitter_sampling = EmitterSampling::lights;
     },
     false, power_of_random_points},
    {"RandomDirections",
     [](auto& settings, View&) {
         settings.points = SamplePoints::random, settings.emitter_sampling = EmitterSampling::directions;
     },
     false, power_of_random_points},
    {"RandomPointsAntialiased",
     [](auto& settings, View&) { settings.points = SamplePoints::random, settings.antialias = true; }, false,
     power_of_random_points},
    {"RouletteAfterOneBounce", [](auto& settings, View&) { settings.roulette_after = 1; }},
    {"Lens", [](auto&, View& view) { view = with_lens(view); }},
    {"Shutter", [](auto& settings, View& view) { settings.view_at_shutter_opening = view; }},
    {"OracleOfAll", [](auto& settings, View&) { settings.oracle = all_in_view(); }},
};

const std::vector<Enclosure>& enclosures() {
    static const std::vector<Enclosure> all = {
        point_at_centre(), attenuated_lamp(), spot_at_centre(),    emissive_sphere(), emissive_half(),
        glowing_ball(),    sun_in_bowl(),     broad_sun_in_bowl(), sky_over_bowl(),   image_over_bowl()};
    return all;
}

class EnclosingSphere : public testing::TestWithParam<int> {};

TEST_P(EnclosingSphere, HasTheRadianceOfItsClosedForm) {
    const Enclosure& enclosure = enclosures()[static_cast<std::size_t>(GetParam())];
    const double error = enclosure.uneven ? uneven_facet_error : facet_error;
    // Looks down and outwards: sees the lower half only, and nothing that is inside.
    const View inside = view_of({0.6f, -0.3f, 0.1f}, {1.0f, -0.6f, 0.3f}, 1.1f);
    // What a bowl gathers is too little for 1 %; 3 % is still what pbrt-v4 allows itself. The ways of sampling are
    // compared with each other more sharply in estimators_agree_test.cpp.
    constexpr double power_of_first_bounce = 0.03, power_of_second_bounce = 0.1;
    for (const bool smooth : {false, true}) {
        Scene scene;
        enclosure.build(scene, smooth);
        const PathTracer tracer(scene);
        for (const Way& way : ways) {
            if (smooth && !way.with_smooth_normals) continue;
            const std::string what = fmt::format("{}, {} normals", way.name, smooth ? "smooth" : "face");
            auto settings = settings_for({"emission", "direct", "indirect.1", "indirect.2", "total", "position"},
                                         enclosure.samples, 2);
            View view = inside;
            way.choose(settings, view);
            const Frame frame = tracer.render(view, settings).frame;
            const double power = way.times_power * power_of_first_bounce;
            for (const float value : frame.plane("emission").values()) ASSERT_EQ(value, enclosure.emission) << what;
            expect_mean(frame, "indirect.1", enclosure.indirect, what, error, power);
            expect_mean(frame, "indirect.2", enclosure.indirect * enclosure.per_bounce, what, error,
                        way.times_power * power_of_second_bounce);
            if (enclosure.direct >= 0.0) {
                expect_mean(frame, "direct", enclosure.direct, what, error, power);
                expect_mean(frame, "total",
                            enclosure.emission + enclosure.direct + enclosure.indirect * (1.0 + enclosure.per_bounce),
                            what, error, power);
            } else if (enclosure.direct_at) {
                expect_mean(
                    frame, "direct",
                    [&](int x, int y) {
                        return enclosure.direct_at(glm::dvec3(colour_at(frame.plane("position"), x, y)));
                    },
                    what, error);
            }
        }
    }
}

// A sphere that glows and absorbs nothing, of a gloss over white: whatever the gloss takes, the white beneath it lacks,
// so that every direction holds the emission once more for each bounce. The share of each is a table's, whose bound
// counts at every bounce.
TEST(EnclosingGloss, OverWhiteAddsOneEmissionPerBounce) {
    constexpr int bounces = 2;
    const View inside = view_of({0.6f, -0.3f, 0.1f}, {1.0f, -0.6f, 0.3f}, 1.1f);
    for (const float roughness : {0.0f, 0.5f}) {
        Scene scene;
        const int white = add_dielectric(scene, glm::vec3(1.0f), roughness, 0.3f);
        scene.materials.back().emission = glm::vec3(1.5f);
        add_mesh(scene, sphere(1.0, white, false));
        const PathTracer tracer(scene);
        const double error = facet_error + (roughness > 0.0f ? SpecularAlbedo::error_bound : 0.0) * (bounces + 1) / 2.0;
        for (const Way& way : ways) {
            auto settings = settings_for({"total"}, 64, bounces);
            View view = inside;
            way.choose(settings, view);
            expect_mean(tracer.render(view, settings).frame, "total", 1.5 * (bounces + 2),
                        fmt::format("{}, roughness {}", way.name, roughness), error, way.times_power * 0.03);
        }
    }
}

// Lamp and camera in the middle of a sphere of rough metal: light comes and goes along the normal, where GGX's lobe is
// D F / 4 = f0 / (4 pi alpha^2). Not antialiased: facets with a sphere's normals are one only to rays through its
// middle.
TEST(EnclosingMetal, ShowsALampBesideTheCameraByTheTopOfItsLobe) {
    const glm::vec3 reflectance(0.95f, 0.6f, 0.4f);
    for (const float roughness : {0.3f, 0.7f, 1.0f}) {
        Scene scene;
        add_mesh(scene, sphere(1.0, add_metal(scene, reflectance, roughness), true));
        scene.point_lights.push_back({"lamp", glm::vec3(0.0f), glm::vec3(2.0f)});
        const View view = view_of({0, 0, 0}, {1.0f, -0.6f, 0.3f}, 1.1f);
        const Frame frame = PathTracer(scene).render(view, settings_for({"direct", "reflection", "total"}, 4, 0)).frame;
        const double alpha = ggx_alpha(roughness);
        const glm::dvec3 expected = glm::dvec3(reflectance) * (2.0 / (4.0 * pi * alpha * alpha));
        for (const std::string plane : {"reflection", "total"}) {
            // Facets lie nearer than the sphere by their error, and interpolated normals are off by less than 1e-4 rad,
            // which the narrowest lobe, 0.09 wide, does not see.
            const int lit = expect_exactly(
                frame, plane, [&](int, int) { return expected; }, fmt::format("roughness {}", roughness), facet_error);
            EXPECT_EQ(lit, view.width() * view.height());
        }
    }
}

// A glowing speck of a tenth of a millimetre, a hundred billion times as bright as what its light leaves after six
// bounces: samples of that must not be rounded as if all the sphere might be as bright.
TEST(EnclosedSpeck, KeepsItsLightThroughSixBounces) {
    constexpr float side = 1e-4f, radiance = 1e6f;
    Scene scene;
    add_sphere(scene, false);
    add_quads(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(radiance), false), {floor_quad(0.5f * side)});
    auto settings = settings_for({"indirect.1", "indirect.6"}, 512, 6);
    const View view = view_of({0.6f, -0.3f, 0.1f}, {1.0f, -0.6f, 0.3f}, 1.1f);
    const ReferenceResult result = PathTracer(scene).render(view, settings);
    EXPECT_TRUE(result.exact);
    const double irradiance = pi * radiance * side * side / (4.0 * pi);
    const auto after = [&](int bounces) { return std::pow(albedo, bounces + 1) * irradiance / pi; };
    expect_mean(result.frame, "indirect.1", after(1), "", uneven_facet_error, 0.03);
    expect_mean(result.frame, "indirect.6", after(6), "", uneven_facet_error, 0.03);
}

INSTANTIATE_TEST_SUITE_P(All, EnclosingSphere, testing::Range(0, static_cast<int>(enclosures().size())),
                         [](const testing::TestParamInfo<int>& test) {
                             return enclosures()[static_cast<std::size_t>(test.param)].name;
                         });

}  // namespace
}  // namespace plumb

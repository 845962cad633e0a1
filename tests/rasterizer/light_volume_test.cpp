// Light volumes: their radius and meshes against the formulas, their light against the sum over lamps pixel by pixel in
// both layers, and the work that they save.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "gl_test.h"
#include "light_run.h"
#include "light_scenes.h"
#include "many_lamps.h"
#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

using LightVolumeTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(LightVolumeTest);

constexpr double pi = glm::pi<double>();

TEST(LightVolumes, TheRadiusIsWhereTheLightFallsBelowTheThreshold) {
    for (const Attenuation& attenuation : {Attenuation{}, Attenuation{0.0f, 1.0f, 0.0f}, Attenuation{1.0f, 0.7f, 1.8f},
                                           Attenuation{0.5f, 2000.0f, 1e-6f}}) {
        for (const float threshold : {1.0f / 256.0f, 0.1f}) {
            const float radius = light_radius(attenuation, 40.0f, threshold);
            EXPECT_NEAR(40.0f * attenuation.evaluate(radius) / threshold, 1.0f, 1e-5f)
                << attenuation.constant << " " << attenuation.linear << " " << attenuation.quadratic;
        }
    }
    EXPECT_FLOAT_EQ(light_radius({}, 4.0f, 1.0f), 2.0f);
    EXPECT_TRUE(std::isinf(light_radius({1.0f, 0.0f, 0.0f}, 4.0f, 1.0f))) << "constant light never falls";
    EXPECT_EQ(light_radius({1.0f, 0.0f, 1.0f}, 0.5f, 1.0f), 0.0f) << "below the threshold from the start";
}

// The tutorial's code, evaluated by hand: (-l + sqrt(l^2 - 4 q (q - I / t))) / (2 q).
TEST(LightVolumes, TheTutorialsCodeTakesTheQuadraticTermForTheConstantOne) {
    const auto by_hand = [](double linear, double quadratic, double relative) {
        return (-linear + std::sqrt(linear * linear - 4.0 * quadratic * (quadratic - relative))) / (2.0 * quadratic);
    };
    const auto by_code = [](const Attenuation& attenuation, float strongest, float threshold) {
        return light_radius(attenuation, strongest, threshold, VolumeRadius::ogldev_code);
    };
    EXPECT_NEAR(by_code({1.0f, 0.7f, 1.8f}, 40.0f, 0.1f), by_hand(0.7, 1.8, 400.0), 1e-4);
    EXPECT_NEAR(by_code({0.0f, 0.0f, 0.3f}, 1.0f, 1.0f / 256.0f), by_hand(0.0, 0.3, 256.0), 1e-4);
    // Where the constant term is the smaller one the light ends before it has fallen to the threshold, and is lost.
    const Attenuation inverse_square{0.0f, 0.0f, 1.0f};
    const float radius = by_code(inverse_square, 4.0f, 1.0f);
    EXPECT_FLOAT_EQ(radius, std::sqrt(3.0f));
    EXPECT_GT(4.0f * inverse_square.evaluate(radius), 1.3f);
    EXPECT_GT(by_code({9.0f, 0.0f, 1.0f}, 10.0f, 1.0f), light_radius({9.0f, 0.0f, 1.0f}, 10.0f, 1.0f));
    EXPECT_EQ(by_code({1.0f, 0.0f, 2.0f}, 1.5f, 1.0f), 0.0f) << "its root of a negative number";
    EXPECT_TRUE(std::isinf(by_code({1.0f, 0.5f, 0.0f}, 4.0f, 1.0f))) << "its division by zero";
}

TEST(LightVolumes, EndlessLightReachesTheFarthestCornerOfTheScene) {
    Scene scene = make_corner();
    scene.point_lights.push_back({"lamp", {-2.0f, 0.0f, -2.0f}, {9, 9, 9}, {1.0f, 0.0f, 0.0f}});
    const LightVolumes volumes(scene, 0.01f);
    ASSERT_EQ(volumes.point_spheres.size(), 1u);
    // The corner's box is 4 x 3 x 4 m; the lamp stands in one of its corners.
    EXPECT_GE(volumes.point_spheres[0].world_from_unit[0][0], std::sqrt(41.0f));
    EXPECT_LE(volumes.point_spheres[0].world_from_unit[0][0], 1.02f * std::sqrt(41.0f));
}

// Every edge is walked once each way, and no facet cuts into the shape.
void expect_closed(const VolumeMesh& mesh) {
    std::map<std::pair<unsigned, unsigned>, int> edges;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        for (std::size_t k = 0; k < 3; ++k) ++edges[{mesh.indices[t + k], mesh.indices[t + (k + 1) % 3]}];
    }
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ(edges.count({edge.second, edge.first}), 1u) << edge.first << " to " << edge.second;
    }
}

// Least distance of a facet's plane before points of the shape, over all facets: not negative if it contains them.
double least_distance(const VolumeMesh& mesh, const std::vector<glm::dvec3>& points) {
    double least = 1e30;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[t]]), b(mesh.positions[mesh.indices[t + 1]]),
            c(mesh.positions[mesh.indices[t + 2]]);
        const glm::dvec3 outwards = glm::normalize(glm::cross(b - a, c - a));
        for (const glm::dvec3& point : points) least = std::min(least, glm::dot(a - point, outwards));
    }
    return least;
}

TEST(LightVolumes, MeshesContainTheirShapes) {
    std::vector<glm::dvec3> sphere, cone{{0.0, 0.0, 0.0}};
    for (int i = 0; i < 200; ++i) {
        const double z = 1.0 - 2.0 * (i + 0.5) / 200, angle = 2.399963 * i, r = std::sqrt(1.0 - z * z);
        sphere.push_back({r * std::cos(angle), r * std::sin(angle), z});
        cone.push_back({std::cos(angle), std::sin(angle), -1.0});
    }
    for (const int subdivisions : {0, 1, 2}) {
        const VolumeMesh mesh = enclosing_sphere(subdivisions);
        expect_closed(mesh);
        EXPECT_EQ(mesh.indices.size(), 60u << (2 * subdivisions));
        EXPECT_GE(least_distance(mesh, sphere), 0.0);
    }
    const VolumeMesh mesh = enclosing_cone(16);
    expect_closed(mesh);
    // The apex lies in the planes of all sides: a rounding of theirs.
    EXPECT_GE(least_distance(mesh, cone), -1e-6);
}

// What all lamps send to a point, and what those of them send whose sphere of radius factor * radius holds the point.
struct LampSum {
    glm::dvec3 light{0.0};
    int lamps = 0;
};
LampSum sum_of_lamps(const Scene& scene, const glm::dvec3& p, const glm::dvec3& n, double threshold, double factor) {
    LampSum sum;
    const auto add = [&](const auto& lamp, double cone) {
        const glm::dvec3 to_light = glm::dvec3(lamp.position) - p;
        const double d = glm::length(to_light);
        const float strongest = std::max({lamp.intensity.x, lamp.intensity.y, lamp.intensity.z});
        if (d > factor * light_radius(lamp.attenuation, strongest, static_cast<float>(threshold))) return;
        sum.light += cone * glm::dvec3(lamp.intensity) * std::max(0.0, glm::dot(n, to_light) / d) / (d * d);
        ++sum.lamps;
    };
    for (const PointLight& lamp : scene.point_lights) add(lamp, 1.0);
    for (const SpotLight& lamp : scene.spot_lights) {
        const double along = glm::dot(glm::normalize(p - glm::dvec3(lamp.position)), glm::dvec3(lamp.direction));
        const double inner = std::cos(static_cast<double>(lamp.inner_angle)),
                     outer = std::cos(static_cast<double>(lamp.outer_angle));
        const double cone = std::clamp((along - outer) / (inner - outer), 0.0, 1.0);
        add(lamp, cone * cone);
    }
    return sum;
}

// How far the meshes reach beyond their light's radius: the sphere's corners by 1.07, those at the base of the widest
// cone here (0.7 radians) by sqrt(1 + (tan 0.7 / cos(pi / 16))^2) = 1.32.
constexpr double mesh_slack = 1.33;

void expect_light_within_bounds(GlContext& context, LocalLights local_lights) {
    Scene scene = make_layered_scene();
    add_lamps(scene, 60, true);
    const View view = corner_view();
    constexpr double threshold = 1.0 / 256.0;
    const Method method = lamp_method(local_lights, threshold);
    for (const std::string prefix : {"", "layer2."}) {
        const Frame frame = render(
            context, scene, view,
            {prefix + "position", prefix + "normal", prefix + "albedo", prefix + "direct", prefix + "depth"}, method);
        int lit = 0, wrong = 0, cut = 0;
        std::string first;
        for (int y = 0; y < view.height(); ++y) {
            for (int x = 0; x < view.width(); ++x) {
                if (std::isinf(frame.plane(prefix + "depth").at(x, y))) {
                    EXPECT_EQ(vector_at(frame.plane(prefix + "direct"), x, y), glm::dvec3(0.0));
                    continue;
                }
                const glm::dvec3 p = vector_at(frame.plane(prefix + "position"), x, y);
                const glm::dvec3 n = vector_at(frame.plane(prefix + "normal"), x, y);
                const glm::dvec3 reflected = vector_at(frame.plane(prefix + "albedo"), x, y) / pi;
                // Half a percent: half floats of albedo and direct light; 1e-5: light that only grazes a
                // surface or the rim of a cone.
                const LampSum least = sum_of_lamps(scene, p, n, threshold, 0.9999);
                const LampSum most = sum_of_lamps(scene, p, n, threshold,
                                                  local_lights == LocalLights::volume_stencil ? mesh_slack : 1e30);
                const LampSum all = sum_of_lamps(scene, p, n, threshold, 1e30);
                const glm::dvec3 direct = vector_at(frame.plane(prefix + "direct"), x, y);
                const glm::dvec3 low = 0.995 * reflected * least.light - 1e-5,
                                 high = 1.005 * reflected * most.light + 1e-5;
                // What is missing stays within the stated error.
                const glm::dvec3 floor =
                    reflected * (0.995 * all.light - threshold * static_cast<double>(all.lamps - least.lamps));
                ++lit;
                cut += least.lamps < all.lamps;
                for (int c = 0; c < 3; ++c) {
                    if (direct[c] >= low[c] && direct[c] <= high[c] && direct[c] >= floor[c]) continue;
                    if (wrong++ == 0) {
                        first = fmt::format("pixel ({}, {}) channel {}: {} not within {} (or {}) to {}", x, y, c,
                                            direct[c], low[c], floor[c], high[c]);
                    }
                }
            }
        }
        EXPECT_GT(lit, prefix.empty() ? 4000 : 700) << prefix;
        EXPECT_GT(cut, lit / 2) << "the volumes are too large to test anything";
        EXPECT_EQ(wrong, 0) << prefix << "; first " << first;
    }
}

TEST_P(LightVolumeTest, VolumesLightBothLayersWithinTheStatedError) {
    expect_light_within_bounds(context(), LocalLights::volume);
}
TEST_P(LightVolumeTest, StencilledVolumesLightOnlySurfacesInsideThemInBothLayers) {
    expect_light_within_bounds(context(), LocalLights::volume_stencil);
}

TEST_P(LightVolumeTest, AVanishingThresholdGivesTheFullScreenPicture) {
    Scene scene = make_layered_scene();
    add_lamps(scene, 20, true);
    const View view = corner_view();
    for (const std::string plane : {"direct", "layer2.direct"}) {
        const Image full = render(context(), scene, view, {plane}, lamp_method(LocalLights::fullscreen)).plane(plane);
        for (const LocalLights local_lights : {LocalLights::volume, LocalLights::volume_stencil}) {
            // Radii of kilometres: they are cut to the scene's size.
            const Image volume = render(context(), scene, view, {plane}, lamp_method(local_lights, 1e-9f)).plane(plane);
            for (std::size_t i = 0; i < full.values().size(); ++i) {
                // A half float's rounding.
                ASSERT_NEAR(volume.values()[i], full.values()[i], 1e-3f * full.values()[i] + 1e-7f)
                    << plane << " " << i;
            }
        }
    }
}

// sqrt(5 / 1 - 1) is 2 metres, and so is sqrt(5 / 1.25): the pictures of the two radii are the same bit for bit.
TEST_P(LightVolumeTest, TheTutorialsRadiusEndsLightWhereAHigherThresholdWould) {
    Scene scene = make_layered_scene();
    scene.point_lights.push_back({"lamp", {0.4f, 1.9f, 0.9f}, {5.0f, 3.0f, 1.0f}});
    const auto light = [&](float threshold, VolumeRadius defined_by) {
        Method method = lamp_method(LocalLights::volume_stencil, threshold);
        method.direct.volume_radius = defined_by;
        return render(context(), scene, corner_view(), {"direct"}, method).plane("direct");
    };
    const Image by_code = light(1.0f, VolumeRadius::ogldev_code), higher = light(1.25f, VolumeRadius::attenuation),
                as_told = light(1.0f, VolumeRadius::attenuation);
    EXPECT_TRUE(std::ranges::equal(by_code.values(), higher.values()));
    int lost = 0;
    for (std::size_t i = 0; i < by_code.values().size(); ++i) {
        ASSERT_LE(by_code.values()[i], as_told.values()[i]);
        lost += by_code.values()[i] < as_told.values()[i];
    }
    EXPECT_GT(lost, 100);
}

// With shadows: the same lookups from another shader.
TEST_P(LightVolumeTest, VolumesCastTheSameShadows) {
    Scene scene = make_layered_scene();
    scene.point_lights.push_back({"lamp", {0.4f, 1.9f, 0.9f}, {9.0f, 7.0f, 5.0f}});
    scene.spot_lights.push_back(
        {"spot", {0.6f, 2.1f, 0.5f}, glm::normalize(glm::vec3(-0.5f, -1.0f, -0.6f)), {20, 15, 10}, 0.3f, 0.7f});
    scene.spot_lights.push_back(
        {"wide", {-0.6f, 2.1f, 0.5f}, glm::normalize(glm::vec3(0.5f, -1.0f, -0.2f)), {2, 5, 4}, 0.3f, 1.3f});
    const View view = corner_view();
    for (const PointShadowMap point_map : {PointShadowMap::cube, PointShadowMap::dual_paraboloid}) {
        Method method = plain_method();
        method.direct.shadow.point_map = point_map;
        method.direct.shadow.cube_size = method.direct.shadow.paraboloid_size = method.direct.shadow.map_size = 256;
        const Image full = render(context(), scene, view, {"direct"}, method).plane("direct");
        method.direct.volume_threshold = 1e-6f;
        method.direct.local_lights = LocalLights::volume_stencil;
        const Image volume = render(context(), scene, view, {"direct"}, method).plane("direct");
        int different = 0;
        for (std::size_t i = 0; i < full.values().size(); ++i) {
            different += std::abs(volume.values()[i] - full.values()[i]) > 2e-3f * full.values()[i] + 1e-5f;
        }
        // Rounding may put a lookup on the other side of a texel's step.
        EXPECT_LE(different, 20);
    }
}

int lit_pixels(const Image& image) {
    int count = 0;
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) count += image.at(x, y) > 0.0f;
    }
    return count;
}

// The first problem that the tutorial ends with: front faces are gone once the camera stands inside the volume.
TEST_P(LightVolumeTest, FrontFacesLoseTheLightWhenTheCameraIsInsideAndBackFacesDoNot) {
    Scene scene = make_corner();
    const View view = corner_view();
    scene.point_lights.push_back({"lamp", {1.0f, 1.5f, 1.5f}, {2.0f, 2.0f, 2.0f}});  // reaches 22 m: past the camera
    const auto lit_with = [&](LocalLights local_lights, VolumeFaces faces) {
        Method method = lamp_method(local_lights);
        method.direct.volume_faces = faces;
        return lit_pixels(render(context(), scene, view, {"direct"}, method).plane("direct"));
    };
    const int full = lit_with(LocalLights::fullscreen, VolumeFaces::back);
    EXPECT_GT(full, 4000);
    EXPECT_EQ(lit_with(LocalLights::volume, VolumeFaces::front), 0);
    EXPECT_EQ(lit_with(LocalLights::volume, VolumeFaces::back), full);
    EXPECT_EQ(lit_with(LocalLights::volume, VolumeFaces::both), full);
    EXPECT_EQ(lit_with(LocalLights::volume_stencil, VolumeFaces::back), full);
}

// From outside either face does; drawn alike, and each pixel once.
TEST_P(LightVolumeTest, FromOutsideFrontAndBackFacesGiveTheSameLight) {
    Scene scene = make_corner();
    scene.point_lights.push_back({"lamp", {-1.0f, 0.6f, -1.0f}, {1.0f, 1.0f, 1.0f}});
    Method method = lamp_method(LocalLights::volume, 1.0f);  // reaches 1 m
    const Image back = render(context(), scene, corner_view(), {"direct"}, method).plane("direct");
    method.direct.volume_faces = VolumeFaces::front;
    const Image front = render(context(), scene, corner_view(), {"direct"}, method).plane("direct");
    EXPECT_GT(lit_pixels(back), 300);
    EXPECT_TRUE(std::ranges::equal(back.values(), front.values()));
}

// Without culling, the tutorial says, light increases outside of the volume, where both faces shade, and is half of
// that inside, where one does.
TEST_P(LightVolumeTest, BothFacesDoubleTheLightFromOutsideAndNotFromInside) {
    Scene scene = make_corner();
    const auto lit_by = [&](VolumeFaces faces, float threshold) {
        Method method = lamp_method(LocalLights::volume, threshold);
        method.direct.volume_faces = faces;
        return render(context(), scene, corner_view(), {"direct"}, method).plane("direct");
    };
    scene.point_lights.push_back({"lamp", {-1.0f, 0.6f, -1.0f}, {1.0f, 1.0f, 1.0f}});
    constexpr float reaches_one_metre = 1.0f, reaches_the_camera = 1.0f / 256.0f;
    const Image once = lit_by(VolumeFaces::back, reaches_one_metre);
    const Image twice = lit_by(VolumeFaces::both, reaches_one_metre);
    EXPECT_GT(lit_pixels(once), 300);
    // A product of a power of two: exact.
    EXPECT_TRUE(std::ranges::equal(once.values(), twice.values(), [](float a, float b) { return 2.0f * a == b; }));
    const Image inside = lit_by(VolumeFaces::back, reaches_the_camera);
    EXPECT_GT(lit_pixels(inside), 4000);
    EXPECT_TRUE(std::ranges::equal(inside.values(), lit_by(VolumeFaces::both, reaches_the_camera).values()));
}

// The second problem: surfaces far behind the volume, or before it, are lit because it covers them on the screen.
TEST_P(LightVolumeTest, TheStencilSparesSurfacesBeforeAndBehindTheVolume) {
    Scene scene = make_corner();
    // In the air before the back wall, reaching 0.4 m: it touches nothing.
    scene.point_lights.push_back({"lamp", {0.2f, 1.2f, 0.6f}, {0.16f, 0.16f, 0.16f}});
    const View view = corner_view();
    LightRun volume(context(), scene, lamp_method(LocalLights::volume, 1.0f), {"direct"}, view);
    LightRun stencil(context(), scene, lamp_method(LocalLights::volume_stencil, 1.0f), {"direct"}, view);
    volume.run(), stencil.run();
    EXPECT_GT(volume.fragments_shaded(), 150u);
    EXPECT_EQ(stencil.fragments_shaded(), 0u);
    // Before it: a pane that hides it wholly.
    Scene hidden = make_corner();
    hidden.point_lights.push_back({"lamp", {-1.7f, 0.3f, -1.7f}, {0.16f, 0.16f, 0.16f}});
    add_quad(hidden, 0, {-2.0f, 0.0f, 0.5f}, {3.0f, 0.0f, 0.0f}, {0.0f, 3.0f, 0.0f});
    LightRun hidden_volume(context(), hidden, lamp_method(LocalLights::volume, 1.0f), {"direct", "layer2.direct"},
                           view);
    LightRun hidden_stencil(context(), hidden, lamp_method(LocalLights::volume_stencil, 1.0f),
                            {"direct", "layer2.direct"}, view);
    hidden_volume.run(), hidden_stencil.run();
    EXPECT_GT(hidden_volume.fragments_shaded(0), 30u);
    EXPECT_EQ(hidden_stencil.fragments_shaded(0), 0u);
    // Behind the pane, in the second layer, it lights the wall.
    EXPECT_GT(hidden_stencil.fragments_shaded(1), 30u);
}

TEST_P(LightVolumeTest, TheGuardBandIsLitAsWell) {
    Scene scene = make_layered_scene();
    add_lamps(scene, 20);
    Method method = lamp_method(LocalLights::fullscreen);
    const Image plain = render(context(), scene, corner_view(), {"direct"}, method).plane("direct");
    method = lamp_method(LocalLights::volume_stencil, 1e-9f);
    method.gbuffer.guard_band = 9;
    const Image banded = render(context(), scene, corner_view(), {"direct"}, method).plane("direct");
    for (std::size_t i = 0; i < plain.values().size(); ++i) {
        // The wider view rounds positions anew: 1e-3 relative at half a millimetre from a lamp's horizon.
        ASSERT_NEAR(banded.values()[i], plain.values()[i], 2e-3f * plain.values()[i] + 1e-5f) << i;
    }
}

}  // namespace
}  // namespace plumb

// Thin panes: what passes them straight through, on the way to a light, along a path, and at the first surface itself.
#include <gtest/gtest.h>

#include "tests/pathtracer/closed_forms.h"
#include "tests/pathtracer/effects_scenes.h"

namespace plumb {
namespace {

using closed_form::pi;

const glm::vec3 tint(0.75f, 0.5f, 0.125f);  // exact in binary
const glm::dvec3 up(0.0, 1.0, 0.0);

// A floor under `panes` horizontal panes, 0.1 m apart from y = 0.5 on, that the camera looks at from below them.
Scene floor_under_panes(int panes, const glm::vec3& pane_albedo = glm::vec3(0.0f)) {
    Scene scene;
    add_quads(scene, add_material(scene, {0.5f, 0.6f, 0.7f}), {floor_quad(3.0f)});
    const int pane = add_pane(scene, tint, pane_albedo);
    for (int i = 0; i < panes; ++i) add_quads(scene, pane, {floor_quad(50.0f, 0.5f + 0.1f * static_cast<float>(i))});
    return scene;
}
View floor_view(int size = 8) { return view_of({0.3f, 0.4f, 0.8f}, {0.1f, 0.0f, 0.1f}, 0.5f, size); }

TEST(Panes, DimAPointLightByTheirColourEach) {
    const glm::dvec3 light(0.21, 1.5, 0.13), intensity(3.0, 2.0, 1.0);
    for (const int panes : {0, 1, 2, 5}) {
        Scene scene = floor_under_panes(panes);
        scene.point_lights.push_back({"lamp", glm::vec3(light), glm::vec3(intensity)});
        const View view = floor_view();
        const Frame frame = PathTracer(scene).render(view, settings_for({"direct"}, 4, 0)).frame;
        expect_exactly(
            frame, "direct",
            [&](int x, int y) {
                const glm::dvec3 offset = light - PixelRay(view, x, y).on_plane(up, 0.0);
                const double squared = glm::dot(offset, offset), cosine = offset.y / std::sqrt(squared);
                return glm::pow(glm::dvec3(tint), glm::dvec3(panes)) * glm::dvec3(glm::vec3(0.5f, 0.6f, 0.7f)) / pi *
                       intensity * (cosine / squared);
            },
            std::to_string(panes) + " panes", 5e-6);
    }
}

TEST(Panes, OfGlassLackWhatTheirSurfaceReflects) {
    const glm::dvec3 light(0.21, 1.5, 0.13);
    Scene scene = floor_under_panes(1);
    scene.materials[1].dielectric_reflectance = 0.25f, scene.materials[1].roughness = 0.0f;
    scene.point_lights.push_back({"lamp", glm::vec3(light), glm::vec3(1.0f)});
    const View view = floor_view();
    const Frame frame = PathTracer(scene).render(view, settings_for({"direct"}, 4, 0)).frame;
    expect_exactly(
        frame, "direct",
        [&](int x, int y) {
            const glm::dvec3 offset = light - PixelRay(view, x, y).on_plane(up, 0.0);
            const double squared = glm::dot(offset, offset), cosine = offset.y / std::sqrt(squared);
            const double passing = 1.0 - (0.25 + 0.75 * std::pow(1.0 - cosine, 5.0));
            return passing * glm::dvec3(tint) * glm::dvec3(glm::vec3(0.5f, 0.6f, 0.7f)) / pi * (cosine / squared);
        },
        "glass", 5e-6);
}

class PanesBySampling : public testing::TestWithParam<EmitterSampling> {
protected:
    static ReferenceSettings settings(std::vector<std::string> planes, int samples, int bounces) {
        ReferenceSettings settings = settings_for(std::move(planes), samples, bounces);
        settings.emitter_sampling = GetParam();
        return settings;
    }
};

// Also where a path that meets the pane may end there, and where it never does.
TEST_P(PanesBySampling, DimAPanelAsLambertsFormulaHasIt) {
    const closed_form::Polygon panel = {{-0.5, 1.2, -0.5}, {0.6, 1.2, -0.5}, {0.6, 1.2, 0.7}, {-0.5, 1.2, 0.7}};
    for (const int panes : {1, 2}) {
        for (const glm::vec3 albedo : {glm::vec3(0.0f), glm::vec3(0.2f)}) {
            Scene scene = floor_under_panes(panes, albedo);
            add_polygon(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(2.0f)), panel);
            const View view = floor_view();
            // Of those that follow directions, few find the panel through both panes.
            const int samples = GetParam() == EmitterSampling::directions ? 20480 : 8192;
            const Frame frame = PathTracer(scene).render(view, settings({"direct"}, samples, 0)).frame;
            const glm::dvec3 colour = glm::pow(glm::dvec3(tint), glm::dvec3(panes)) * glm::dvec3(0.5, 0.6, 0.7);
            expect_mean(
                frame, "direct",
                [&](int x, int y) {
                    const glm::dvec3 point = PixelRay(view, x, y).on_plane(up, 0.0);
                    return 1.0 / pi * 2.0 * closed_form::polygon_irradiance(point, up, panel);
                },
                std::to_string(panes) + " panes of albedo " + std::to_string(albedo.x), 0.0, 0.01, colour);
        }
    }
}

// What a pane itself emits arrives whether paths end at it or always pass it.
TEST_P(PanesBySampling, ThatGlowLightWhatIsBelow) {
    const closed_form::Polygon panel = {{-0.5, 0.6, -0.5}, {0.6, 0.6, -0.5}, {0.6, 0.6, 0.7}, {-0.5, 0.6, 0.7}};
    for (const glm::vec3 albedo : {glm::vec3(0.0f), glm::vec3(0.2f)}) {
        Scene scene;
        add_quads(scene, add_material(scene, glm::vec3(0.5f)), {floor_quad(3.0f)});
        const int glowing = add_pane(scene, glm::vec3(0.5f), albedo);
        scene.materials.back().emission = glm::vec3(2.0f);
        add_polygon(scene, glowing, panel);
        scene.environment.radiance = glm::vec3(1.0f);
        const View view = floor_view();
        const Frame frame = PathTracer(scene).render(view, settings({"direct"}, 4096, 0)).frame;
        expect_mean(
            frame, "direct",
            [&](int x, int y) {
                const glm::dvec3 point = PixelRay(view, x, y).on_plane(up, 0.0);
                const double irradiance = closed_form::polygon_irradiance(point, up, panel);
                return 0.5 / pi * (pi + irradiance * (2.0 - 0.5));  // the sky, less what the pane keeps of it
            },
            "albedo " + std::to_string(albedo.x));
    }
}

TEST_P(PanesBySampling, ShowWhatIsBehindThemAsReflection) {
    // Two panes before an emitter, a lit wall and the sky, of which the camera sees a third each.
    const glm::vec3 emission(3.0f, 2.0f, 1.0f), albedo(0.3f, 0.5f, 0.7f), sky(0.25f, 0.5f, 1.0f);
    const glm::dvec3 light(0.2, 0.3, -2.0);
    for (const int panes : {1, 2}) {
        Scene scene;
        const int pane = add_pane(scene, tint);
        for (int i = 0; i < panes; ++i) {
            const float z = -1.0f - 0.2f * static_cast<float>(i);
            add_quads(scene, pane, {{{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}}});
        }
        add_quads(scene, add_material(scene, glm::vec3(0.0f), emission),
                  {{{-9, -9, -3}, {-0.31f, -9, -3}, {-0.31f, 9, -3}, {-9, 9, -3}}});
        add_quads(scene, add_material(scene, albedo), {{{0.33f, -9, -3}, {9, -9, -3}, {9, 9, -3}, {0.33f, 9, -3}}});
        scene.point_lights.push_back({"lamp", glm::vec3(light), glm::vec3(1.0f)});
        scene.environment.radiance = sky;
        const View view = view_of({0, 0, 0}, {0, 0, -1}, 0.6f, 12);
        const Frame frame =
            PathTracer(scene).render(view, settings({"reflection", "direct", "emission"}, 1024, 1)).frame;
        const glm::dvec3 passing = glm::pow(glm::dvec3(tint), glm::dvec3(panes));
        const auto seen = [&](int x, int y) { return PixelRay(view, x, y).on_plane({0, 0, 1}, -3.0); };
        int walls = 0, emitters = 0, open = 0;
        for (int y = 0; y < 12; ++y) {
            for (int x = 0; x < 12; ++x) {
                const glm::dvec3 point = seen(x, y);
                if (point.x > 0.33) {
                    ++walls;
                    continue;
                }
                // Neither noise nor chance: what is seen is the same for every sample.
                const bool emitter = point.x < -0.31;
                ++(emitter ? emitters : open);
                for (int c = 0; c < 3; ++c) {
                    const double expected = passing[c] * static_cast<double>(emitter ? emission[c] : sky[c]);
                    EXPECT_NEAR(frame.plane("reflection").at(x, y, c), expected, 2e-6 * expected) << x << ", " << y;
                    EXPECT_EQ(frame.plane("variance.reflection").at(x, y, c), 0.0f);
                }
            }
        }
        EXPECT_GT(walls, 20);
        EXPECT_GT(emitters, 20);
        EXPECT_GT(open, 20);
        // The wall is lit by the lamp, and by the sky and the emitter's edge besides, without the lamp.
        Scene dark = scene;
        dark.point_lights.clear();
        const Frame without = PathTracer(dark).render(view, settings({"reflection"}, 1024, 1)).frame;
        for (int y = 0; y < 12; ++y) {
            for (int x = 0; x < 12; ++x) {
                const glm::dvec3 offset = light - seen(x, y);
                if (seen(x, y).x < 0.33) continue;
                const double squared = glm::dot(offset, offset), cosine = offset.z / std::sqrt(squared);
                for (int c = 0; c < 3; ++c) {
                    const double expected = passing[c] * static_cast<double>(albedo[c]) / pi * cosine / squared;
                    // The same paths in both, so that their difference has no noise but the rounding of the sum.
                    EXPECT_NEAR(frame.plane("reflection").at(x, y, c) - without.plane("reflection").at(x, y, c),
                                expected, 1e-5 * expected + 1e-6)
                        << x << ", " << y;
                }
            }
        }
        for (const float value : frame.plane("direct").values()) EXPECT_EQ(value, 0.0f);
        for (const float value : frame.plane("emission").values()) EXPECT_EQ(value, 0.0f);
    }
}

INSTANTIATE_TEST_SUITE_P(All, PanesBySampling, testing::ValuesIn(all_strategies),
                         [](const auto& test) { return name_of(test.param); });

// White sheets that let half of the light pass, diffuse and glossy, in a sky of radiance 1: one shows 1; of several,
// each showing what the others show, K bounces lack what would need more, and never is there more than 1.
TEST(Panes, ShowNoMoreThanWhatSurroundsThem) {
    for (const float reflectance : {0.0f, 0.2f}) {
        for (const float roughness : {0.0f, 0.5f}) {
            const double bound = reflectance > 0.0f && roughness > 0.0f ? SpecularAlbedo::error_bound : 0.0;
            for (const int panes : {1, 3}) {
                double last = 0.0;
                for (const int bounces : {1, 3, 16}) {
                    Scene scene;
                    const int pane = add_pane(scene, glm::vec3(0.5f), glm::vec3(0.5f));
                    scene.materials.back().dielectric_reflectance = reflectance;
                    scene.materials.back().roughness = roughness;
                    for (int i = 0; i < panes; ++i) {
                        add_quads(scene, pane, {floor_quad(2.0f, -0.2f * static_cast<float>(i))});
                    }
                    scene.environment.radiance = glm::vec3(1.0f);
                    auto settings = settings_for({"total"}, 1024, bounces);
                    settings.roulette_after = 0;
                    const Frame frame =
                        PathTracer(scene).render(view_of({0.3f, 1.5f, 0.4f}, {0, 0, 0}, 0.5f, 8), settings).frame;
                    double mean = 0.0;
                    for (const float value : frame.plane("total").values()) mean += value / (3.0 * 64.0);
                    const std::string what = std::to_string(panes) + " panes, reflectance " +
                                             std::to_string(reflectance) + ", bounces " + std::to_string(bounces);
                    // A path in such a stack loses half of its light to the outside at least every other bounce.
                    const double lacking = panes == 1 ? 0.0 : std::pow(0.9, bounces);
                    EXPECT_LT(mean, 1.0 + (panes == 1 ? 1.0 : 3.0) * bound + 0.01) << what;
                    EXPECT_GT(mean, 1.0 - lacking - (panes == 1 ? 1.0 : 3.0) * bound - 0.01) << what;
                    EXPECT_GE(mean, last - 0.01) << what;
                    last = mean;
                    if (panes == 1) expect_mean(frame, "total", 1.0, what, bound);
                }
            }
        }
    }
}

TEST(Panes, AreSurfacesToAmbientVisibility) {
    for (const Falloff falloff : {Falloff::hard, Falloff::quadratic}) {
        Scene scene = floor_under_panes(1);
        add_quads(scene, 0, {floor_quad(1.0f, 0.45f)}, glm::mat4(1.0f));
        scene.environment.radiance = glm::vec3(1.0f);
        auto settings = settings_for({"ao", "direct"}, 64, 0);
        settings.quantities.ao_radius = 2.0f, settings.quantities.ao_falloff = falloff;
        const View view = floor_view();
        const Frame with_pane = PathTracer(scene).render(view, settings).frame;
        scene.materials[1].transmission = glm::vec3(0.0f);
        const Frame opaque = PathTracer(scene).render(view, settings).frame;
        for (std::size_t i = 0; i < opaque.plane("ao").values().size(); ++i) {
            EXPECT_EQ(with_pane.plane("ao").values()[i], opaque.plane("ao").values()[i]);
        }
    }
}

}  // namespace
}  // namespace plumb

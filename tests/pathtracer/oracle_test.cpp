// The oracle: rays meet what the first layers of a view hold, and nothing else.
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pathtracer/reference_error.h"
#include "scenes/builtin.h"
#include "tests/pathtracer/effects_scenes.h"

namespace plumb {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

ReferenceSettings settings_of(const std::optional<OracleSettings>& oracle, std::vector<std::string> planes,
                              int samples = 64, int bounces = 1) {
    ReferenceSettings settings = settings_for(std::move(planes), samples, bounces);
    settings.quantities.ao_radius = infinity, settings.quantities.ao_falloff = Falloff::hard;
    settings.oracle = oracle;
    return settings;
}

// Of the floor y = 0, straight down.
View from_above(int size = 32) { return view_of({0, 4, 0}, {0, 0, 0}, 0.5f, size, {0, 0, -1}); }

double mean_of(const Image& image) {
    double sum = 0.0;
    for (const float value : image.values()) sum += value;
    return sum / static_cast<double>(image.values().size());
}

TEST(Oracle, OfOneLayerLacksWhatTheFirstHides) {
    Scene scene;
    const int grey = add_material(scene, glm::vec3(0.5f));
    add_quads(scene, grey, {floor_quad(3.0f)});
    add_quads(scene, grey, {floor_quad(0.4f, 2.0f)});   // hides ...
    add_quads(scene, grey, {floor_quad(0.15f, 1.0f)});  // ... this
    const PathTracer tracer(scene);
    Scene without = scene;
    without.instances.pop_back();
    const PathTracer tracer_without(without);
    const View view = from_above();
    const Frame truth = tracer.render(view, settings_of({}, {"ao"})).frame;
    const Frame lid_alone = tracer_without.render(view, settings_of({}, {"ao"})).frame;
    const auto oracle = [&](int layers) {
        return tracer.render(view, settings_of(OracleSettings{view, layers, 0.1f}, {"ao"})).frame;
    };
    const Frame one = oracle(1), two = oracle(2), three = oracle(3), all = oracle(0);
    int differs = 0;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            // The camera looks at the floor here, not at the lid, whose own visibility is 1.
            EXPECT_EQ(one.plane("ao").at(x, y), lid_alone.plane("ao").at(x, y)) << x << ", " << y;
            // The slab's edge lies within its pixels' width; a ray may pass there either side.
            EXPECT_NEAR(two.plane("ao").at(x, y), truth.plane("ao").at(x, y), 2.0 / 64.0) << x << ", " << y;
            EXPECT_EQ(all.plane("ao").at(x, y), truth.plane("ao").at(x, y)) << x << ", " << y;
            differs += truth.plane("ao").at(x, y) < lid_alone.plane("ao").at(x, y) ? 1 : 0;
        }
    }
    EXPECT_GT(differs, 100);
    EXPECT_NEAR(mean_of(two.plane("ao")), mean_of(truth.plane("ao")), 2e-3);
    EXPECT_NEAR(mean_of(three.plane("ao")), mean_of(truth.plane("ao")), 2e-3);
}

// A wall beside the view: no number of layers knows of it until the guard band reaches it.
TEST(Oracle, KnowsOfWhatLiesBesideTheViewByItsGuardBand) {
    Scene scene;
    const int grey = add_material(scene, glm::vec3(0.5f));
    add_quads(scene, grey, {floor_quad(3.0f)});
    const View view = from_above();
    const PathTracer floor_alone(scene);
    // The view ends at x = 4 tan(0.25) = 1.02; the wall leans so that its inside is seen from above.
    Scene walled = scene;
    add_quads(walled, grey, {{{1.2f, 0, 3}, {1.2f, 0, -3}, {1.6f, 1, -3}, {1.6f, 1, 3}}});
    const PathTracer tracer(walled);
    const Frame truth = tracer.render(view, settings_of({}, {"ao"})).frame;
    for (const int layers : {1, 2, 0}) {
        const Frame narrow = tracer.render(view, settings_of(OracleSettings{view, layers, 0.1f}, {"ao"})).frame;
        for (const float value : narrow.plane("ao").values()) EXPECT_EQ(value, 1.0f) << layers << " layers";
        // At the top of the wall, x / depth = 1.6 / 3: tan(0.25) * 16 pixels more is 33 pixels to that side. The far
        // ends, |z| <= 3, need 3 / 3 / tan(0.25) * 16 = 63 pixels from the centre.
        const View wide = view.with_guard_band(50);
        const Frame seen = tracer.render(view, settings_of(OracleSettings{wide, layers, 0.1f}, {"ao"})).frame;
        for (int y = 0; y < view.height(); ++y) {
            for (int x = 0; x < view.width(); ++x) {
                EXPECT_NEAR(seen.plane("ao").at(x, y), truth.plane("ao").at(x, y), layers == 0 ? 0.0 : 3.0 / 64.0)
                    << layers << " layers, " << x << ", " << y;
            }
        }
        // What the band's pixels hold ends within their width.
        EXPECT_NEAR(mean_of(seen.plane("ao")), mean_of(truth.plane("ao")), 2e-3);
        EXPECT_LT(mean_of(seen.plane("ao")), 0.97);
    }
}

// The same of the light that a bounce and a mirror bring from the wall, whose inside a sun lights that passes along the
// floor.
TEST(Oracle, KnowsOfLightFromBesideTheViewByItsGuardBand) {
    Scene scene;
    add_quads(scene, add_dielectric(scene, glm::vec3(0.5f), 0.0f, 0.4f), {floor_quad(3.0f)});
    add_quads(scene, add_material(scene, glm::vec3(0.5f)),
              {{{1.2f, 0, 3}, {1.2f, 0, -3}, {1.6f, 1, -3}, {1.6f, 1, 3}}});
    scene.directional_lights.push_back({"sun", {1, 0, 0}, glm::vec3(3.0f)});
    const PathTracer tracer(scene);
    // The layers are those of the floor from above, finely: a guard band as wide as in the test before is 28 of 66
    // pixels over the wall.
    const View layers_view = from_above(128), view = view_of({-1.2f, 0.8f, 0}, {0.6f, 0, 0}, 0.3f);
    const std::vector<std::string> planes = {"indirect.1", "reflection"};
    const Frame truth = tracer.render(view, settings_of({}, planes, 256)).frame;
    for (const int layers : {1, 2, 0}) {
        const auto seen_with = [&](int guard_band) {
            const OracleSettings oracle{layers_view.with_guard_band(guard_band), layers, 0.1f};
            return tracer.render(view, settings_of(oracle, planes, 256)).frame;
        };
        const Frame narrow = seen_with(0), wide = seen_with(200);
        for (const std::string& plane : planes) {
            const std::string what = fmt::format("{} layers, {}", layers, plane);
            EXPECT_GT(mean_of(truth.plane(plane)), 1e-3) << what;
            const auto known = truth.plane(plane).values(), without = narrow.plane(plane).values(),
                       with = wide.plane(plane).values();
            for (std::size_t i = 0; i < known.size(); ++i) {
                EXPECT_EQ(without[i], 0.0f) << what << ", value " << i;
                // What the band's pixels hold ends within their width.
                EXPECT_LE(with[i], known[i] * (layers == 0 ? 1.0f : 1.00001f)) << what << ", value " << i;
            }
            EXPECT_GE(mean_of(wide.plane(plane)), (layers == 0 ? 1.0 : 0.95) * mean_of(truth.plane(plane))) << what;
        }
    }
}

// The same rays meet ever more as layers are added, pixel by pixel.
TEST(Oracle, GrowsLayerByLayerTowardsTheTruth) {
    for (const Falloff falloff : {Falloff::hard, Falloff::quadratic, Falloff::cubic}) {
        const Scene scene = make_clutter();
        const View view(scene.cameras[0], 40, 24);
        const PathTracer tracer(scene);
        std::vector<Image> planes;
        for (const int layers : {1, 2, 3, 0, -1}) {
            auto settings = settings_of(
                layers < 0 ? std::optional<OracleSettings>() : OracleSettings{view.with_guard_band(4), layers, 0.05f},
                {"ao"}, 16);
            settings.quantities.ao_radius = 1.0f, settings.quantities.ao_falloff = falloff;
            planes.push_back(tracer.render(view, settings).frame.plane("ao"));
        }
        for (std::size_t i = 1; i < planes.size(); ++i) {
            int less = 0;
            for (std::size_t j = 0; j < planes[i].values().size(); ++j) {
                EXPECT_GE(planes[i - 1].values()[j], planes[i].values()[j]) << "step " << i << ", pixel " << j;
                less += planes[i - 1].values()[j] > planes[i].values()[j] ? 1 : 0;
            }
            EXPECT_GT(less, 0) << "step " << i << " changes nothing: the scene proves nothing";
        }
    }
}

// Light along +X falls on nothing but two slanted slabs, one as the second and one as the third layer below lids that
// hide them from above, and nothing shadows anything: what a bounce and a mirror make of a slab is there once
// its layer is.
struct HiddenSlabs {
    Scene scene;
    enum Slabs { none = 0, second_layer = 1, third_layer = 2, both = 3 };

    explicit HiddenSlabs(Slabs slabs) {
        const int grey = add_material(scene, glm::vec3(0.5f));
        add_quads(scene, add_dielectric(scene, glm::vec3(0.5f), 0.0f, 0.4f), {floor_quad(3.0f)});
        add_quads(scene, grey, {floor_quad(0.9f, 2.0f)});
        add_quads(scene, grey, {{{-0.5f, 1.6f, 0.7f}, {0.5f, 1.6f, 0.7f}, {0.5f, 1.6f, 0}, {-0.5f, 1.6f, 0}}});
        if ((slabs & second_layer) != 0) add_slab(grey, -0.6f, -0.1f);
        if ((slabs & third_layer) != 0) add_slab(grey, 0.1f, 0.6f);
        scene.directional_lights.push_back({"sun", {1, 0, 0}, glm::vec3(3.0f)});
    }
    // Its lit side looks down.
    void add_slab(int material, float near, float far) {
        add_quads(scene, material, {{{-0.2f, 1.1f, near}, {-0.2f, 1.1f, far}, {0.2f, 0.7f, far}, {0.2f, 0.7f, near}}});
    }
};

TEST(Oracle, BouncesAndMirrorsKnowASlabFromItsLayerOn) {
    // From above, finely: a slab is lost where it covers less than a pixel's centre, which of n x n pixels are
    // 1 / (2 n), here 0.5 %. Seen from the side, below the lids.
    const View layers_view = from_above(1024), view = view_of({-0.3f, 0.5f, 1.9f}, {0, 0, 1}, 0.7f, 24);
    const std::vector<std::string> oracle_planes = {"indirect.1", "reflection"};
    const auto rendered = [&](HiddenSlabs::Slabs slabs, const std::optional<OracleSettings>& oracle) {
        const HiddenSlabs hidden(slabs);
        return PathTracer(hidden.scene).render(view, settings_of(oracle, oracle_planes, 256)).frame;
    };
    const Frame truth = rendered(HiddenSlabs::both, {}), second_alone = rendered(HiddenSlabs::second_layer, {});
    for (int layers = 1; layers <= 3; ++layers) {
        const Frame* expected = layers == 1 ? nullptr : layers == 2 ? &second_alone : &truth;
        const Frame frame = rendered(HiddenSlabs::both, OracleSettings{layers_view, layers, 0.1f});
        for (const std::string& plane : oracle_planes) {
            const std::string what = fmt::format("{} layers, {}", layers, plane);
            const Image& image = frame.plane(plane);
            if (!expected) {
                for (const float value : image.values()) EXPECT_EQ(value, 0.0f) << what;
                continue;
            }
            // The same rays meet the same slabs, but for their borders.
            const Image& known = expected->plane(plane);
            for (std::size_t i = 0; i < image.values().size(); ++i) {
                EXPECT_LE(image.values()[i], known.values()[i] * 1.00001f) << what << ", value " << i;
            }
            EXPECT_GT(mean_of(image), 0.98 * mean_of(known)) << what;
        }
    }
    for (const std::string& plane : oracle_planes) {
        EXPECT_GT(mean_of(second_alone.plane(plane)), 1e-4) << plane;
        EXPECT_GT(mean_of(truth.plane(plane)), 1.2 * mean_of(second_alone.plane(plane))) << plane;
    }
}

// A G-buffer is that of one moment.
TEST(Oracle, RefusesAnOpenShutter) {
    const HiddenSlabs hidden(HiddenSlabs::none);
    auto settings = settings_of(OracleSettings{from_above(), 1, 0.1f}, {"ao"}, 2);
    settings.view_at_shutter_opening = from_above();
    try {
        PathTracer(hidden.scene).render(from_above(), settings);
        FAIL() << "no error";
    } catch (const ReferenceError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("shutter"));
    }
}

TEST(Oracle, OfAllThatTheFrustumHoldsIsTheTruthWhereItHoldsEverything) {
    Scene scene = make_cornell();
    for (Material& material : scene.materials) material.dielectric_reflectance = 0.2f, material.roughness = 0.5f;
    // From far outside, where the whole box is in view; all of it lies between the camera's planes.
    Camera camera = scene.cameras[0];
    camera.near_plane = 1e-3f, camera.far_plane = 100.0f;
    const View view(camera, 24, 24);
    const PathTracer tracer(scene);
    auto settings = settings_of({}, {"ao", "direct", "indirect.1", "indirect.2", "reflection"}, 16, 2);
    settings.emitter_sampling = EmitterSampling::lights;  // as an oracle does
    const Frame truth = tracer.render(view, settings).frame;
    EXPECT_GT(mean_of(truth.plane("reflection")), 1e-3);
    settings.oracle = OracleSettings{view.with_guard_band(400), 0, 0.1f};
    expect_same_bits(tracer.render(view, settings).frame, truth);
}

// Shadows are those of the whole scene, however little of it the view holds.
TEST(Oracle, LeavesDirectLightAlone) {
    Scene scene = make_cornell();
    scene.point_lights.push_back({"lamp", scene.bounds().centre(), glm::vec3(0.2f)});
    scene.environment.radiance = glm::vec3(0.3f);
    const View view(scene.cameras[0], 24, 24);
    const PathTracer tracer(scene);
    auto settings = settings_of({}, {"direct"}, 16);
    settings.emitter_sampling = EmitterSampling::lights;
    const Frame truth = tracer.render(view, settings).frame;
    for (const int layers : {1, 0}) {
        settings.oracle = OracleSettings{view, layers, 0.1f};
        expect_same_bits(tracer.render(view, settings).frame, truth);
    }
}

// What lies behind a pane is known as little as anything else: a lit wall beside the view, of which a bounce would see
// the light through the pane.
TEST(Oracle, HoldsBehindPanesAsWell) {
    for (const bool has_pane : {false, true}) {
        Scene scene;
        const int grey = add_material(scene, glm::vec3(0.5f));
        add_quads(scene, grey, {floor_quad(3.0f)});
        add_quads(scene, grey, {{{1.5f, 0, 3}, {1.5f, 0, -3}, {1.9f, 1, -3}, {1.9f, 1, 3}}});
        if (has_pane) {
            add_quads(scene, add_pane(scene, glm::vec3(0.75f)),
                      {{{0.7f, 0, 3}, {0.7f, 0, -3}, {0.71f, 1, -3}, {0.71f, 1, 3}}});
        }
        scene.point_lights.push_back({"lamp", {0.1f, 0.7f, 0.0f}, glm::vec3(1.0f)});
        const View view = from_above(16);
        const PathTracer tracer(scene);
        const Frame truth = tracer.render(view, settings_of({}, {"indirect.1"})).frame;
        EXPECT_GT(mean_of(truth.plane("indirect.1")), 1e-4);
        for (const int layers : {1, 0}) {
            const Frame frame =
                tracer.render(view, settings_of(OracleSettings{view, layers, 0.1f}, {"indirect.1"})).frame;
            for (const float value : frame.plane("indirect.1").values()) {
                EXPECT_EQ(value, 0.0f) << layers << " layers, pane: " << has_pane;
            }
        }
    }
}

}  // namespace
}  // namespace plumb

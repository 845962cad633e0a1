// Russian roulette changes no expectation: against the geometric series of a closed room, and against no roulette.
#include <gtest/gtest.h>

#include "tests/pathtracer/estimator_comparisons.h"

namespace plumb {
namespace {

// Walls of albedo 0.9 that glow with radiance 1: `total` is the sum of 0.9^k over the emission, the segment to x and 64
// bounces. Of paths with roulette from the first bounce on, 0.9^64 = 0.1 % see the last one.
TEST(Roulette, KeepsTheSumOfSixtyFourBounces) {
    constexpr int bounces = 64;
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.9f), glm::vec3(1.0f)), room_quads());
    const View view = view_of({0.1f, 0.2f, 0.3f}, {1, -0.9f, -0.8f}, 1.0f, 8);
    const double albedo = 0.9f, expected = (1.0 - std::pow(albedo, bounces + 2)) / (1.0 - albedo);
    for (const int after : {0, 1, 8}) {
        auto settings = settings_for({"total", "indirect.20"}, after == 0 ? 16 : 4096, bounces);
        settings.roulette_after = after;
        settings.emitter_sampling = EmitterSampling::directions;  // whatever noise there is, is that of the roulette
        const ReferenceResult result = PathTracer(scene).render(view, settings);
        const std::string what = "roulette after " + std::to_string(after);
        // 64 roundings of the throughput to float32. Of all paths 0.9^20 = 12 % see the twentieth bounce, so that 2 %
        // is what as many samples can tell.
        expect_mean(result.frame, "total", expected, what, 1e-5);
        expect_mean(result.frame, "indirect.20", std::pow(albedo, 21), what, 1e-5, 0.02);
        // The first bounces are certain; then a path survives with its throughput, 0.9^after, and has 10 more on
        // average.
        const double rays = static_cast<double>(result.rays) / (64.0 * settings.samples);
        const double expected_rays = after == 0 ? bounces + 1 : after + 1 + 10.0 * std::pow(albedo, after);
        EXPECT_NEAR(rays, expected_rays, 0.01 * expected_rays) << what;
    }
}

TEST(Roulette, AgreesWithNoneForPathsThroughGlossAndPanes) {
    Setting setting = room_with_a_pane();
    Material& walls = setting.scene.materials[0];
    walls.dielectric_reflectance = 0.2f, walls.roughness = 0.6f;
    setting.view = View(setting.view.camera(), 2, 2);
    expect_agreement(Comparison{std::move(setting), roulette_after(1), roulette_after(0), {"indirect"}, 3, 32768, 10});
}

}  // namespace
}  // namespace plumb

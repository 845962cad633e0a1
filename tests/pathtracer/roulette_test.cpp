// What paths decide by chance changes no expectation: Russian roulette against the geometric series of a closed room
// and against none, and how often it and panes decide which way.
#include <gtest/gtest.h>

#include "tests/pathtracer/chi_square.h"
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

// How many paths of those that are told apart by `outcome`, one path for each half of each pixel, come out each way.
// The counts must be those of the probabilities, by the chi-square test, which must see any of them changed by 1 %.
void expect_outcomes(const Scene& scene, const View& view, ReferenceSettings settings, const std::string& plane,
                     const std::vector<double>& probabilities, const std::function<std::size_t(float)>& outcome) {
    settings.samples = 2;
    std::vector<double> counts(probabilities.size(), 0.0);
    const PathTracer tracer(scene);
    for (const SamplePoints points : {SamplePoints::sobol, SamplePoints::random}) {
        settings.points = points, ++settings.seed;
        const Frame frame = tracer.render(view, settings).frame;
        for (const std::string half : {"half_a.", "half_b."}) {
            const Image& image = frame.plane(half + plane);
            for (int i = 0; i < view.width() * view.height(); ++i) {
                ++counts[outcome(image.at(i % view.width(), i / view.width(), 1))];
            }
        }
    }
    const double significance = significance_of_one_test();
    const ChiSquareResult right = chi_square(counts, probabilities);
    EXPECT_GE(right.p_value, significance) << plane << ": chi-square " << right.statistic;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        for (const double factor : {0.99, 1.01}) {
            std::vector<double> wrong = probabilities;
            wrong[i] *= factor;
            const double others = (1.0 - wrong[i]) / (1.0 - probabilities[i]);
            for (std::size_t j = 0; j < wrong.size(); ++j) wrong[j] *= j == i ? 1.0 : others;
            EXPECT_LT(chi_square(counts, wrong).p_value, significance)
                << plane << ": outcome " << i << " times " << factor << ", unseen";
        }
    }
}

// Of paths in a room of albedo 0.7 with roulette from the first bounce on, 0.7 see their second bounce and 0.7^2 their
// third, each for all that do not.
TEST(Roulette, LetsPathsGoOnWithTheirThroughput) {
    constexpr float albedo = 0.7f;
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(albedo), glm::vec3(1.0f)), room_quads());
    const View view = view_of({0.1f, 0.2f, 0.3f}, {1, -0.9f, -0.8f}, 1.0f, 512);
    for (const int bounce : {2, 3}) {
        const std::string plane = fmt::format("indirect.{}", bounce);
        auto settings = settings_for({plane}, 2, 3);
        settings.roulette_after = 1, settings.emitter_sampling = EmitterSampling::directions;
        const double goes_on = std::pow(static_cast<double>(albedo), bounce - 1);
        const double value = std::pow(static_cast<double>(albedo), bounce + 1) / goes_on;
        expect_outcomes(scene, view, settings, plane, {1.0 - goes_on, goes_on}, [&](float found) {
            EXPECT_TRUE(found == 0.0f || std::abs(found - value) < 1e-5 * value) << found;
            return found > 0.0f ? 1u : 0u;
        });
    }
}

// A ray that meets panes passes each with the share of what passes of all that does not vanish there, whatever it did
// at the pane before.
TEST(PaneChoice, PassesByTheShareOfWhatPasses) {
    constexpr float transmission = 0.5f, albedo = 0.3f;
    for (const int panes : {1, 2}) {
        Scene scene;
        add_quads(scene, add_material(scene, glm::vec3(0.5f)), {floor_quad(1.0f)});
        const int pane = add_material(scene, glm::vec3(albedo));
        scene.materials.back().transmission = glm::vec3(transmission);
        // So wide that a ray in a million goes by.
        for (int i = 0; i < panes; ++i) {
            add_quads(scene, pane, {floor_quad(1000.0f, 0.5f + 0.1f * static_cast<float>(i))});
        }
        scene.environment.radiance = glm::vec3(1.0f);
        const View view = view_of({0.1f, 0.4f, 0.3f}, {0, 0, 0}, 0.5f, 512);
        auto settings = settings_for({"direct"}, 2, 0);
        settings.emitter_sampling = EmitterSampling::directions;
        // What vanishes in a pane leaves the rest of its colour: a base colour of which so much passes.
        const SurfaceSample surface = scene.surface(scene.materials.back(), {});
        const double passing = surface.transmission.x, ending = surface.albedo.x;
        const double share = std::pow(passing / (passing + ending), panes);
        expect_outcomes(scene, view, settings, "direct", {1.0 - share, share},
                        [](float found) { return found > 0.0f ? 1u : 0u; });
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

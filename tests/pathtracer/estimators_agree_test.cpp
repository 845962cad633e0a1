// Ways of rendering agree (see estimator_comparisons.h), and anti-aliasing is the mean over the pixel.
#include <gtest/gtest.h>

#include "tests/pathtracer/closed_forms.h"
#include "tests/pathtracer/estimator_comparisons.h"

namespace plumb {
namespace {

std::vector<Comparison> comparisons() {
    const Way lights = by(EmitterSampling::lights), directions = by(EmitterSampling::directions),
              both = by(EmitterSampling::both);
    const std::vector<std::string> direct = {"direct"}, first_bounce = {"direct", "indirect.1"};
    return {
        {room(), lights, both, first_bounce, 1, 8192},
        {room(), directions, both, direct},
        {open_air(), lights, both, direct},
        {open_air(), directions, both, direct},
        {small_light(), lights, both, direct},
        {glancing_light(), lights, both, direct, 1, 4096},
        {glancing_light(), directions, both, direct},
        {glossy_room(), lights, both, {"direct", "reflection"}, 0},
        {glossy_room(), directions, both, {"direct", "reflection"}, 0, 8192},
        {room_with_a_pane(), lights, both, direct, 0},
        {room_with_a_pane(), directions, both, direct, 0, 12288},
        {faceted_ball(), lights, both, direct},
        {faceted_ball(), directions, both, direct, 0, 8192},
        {faceted_ball(true), lights, both, {"direct", "reflection"}, 0},
        {faceted_ball(true), directions, both, {"direct", "reflection"}, 0, 8192},
        {room(), half_a, half_b, first_bounce, 1, 12288},
        {room(), as_it_is, random_points, first_bounce, 1, 12288},
        {room(), as_it_is, shards, first_bounce, 1, 8192},  // of other seeds
        {room(), roulette_after(0), roulette_after(1), {"indirect"}, 2, 4096},
        {room(), antialiased, with(antialiased, random_points), first_bounce, 1, 12288},
        {small_light(), antialiased, with(antialiased, lights), direct},
        {open_air(), antialiased, with(antialiased, directions), direct},
    };
}

class EstimatorsAgree : public testing::TestWithParam<int> {};

TEST_P(EstimatorsAgree, AndWouldNotWithABiasOfOnePercent) {
    expect_agreement(comparisons()[static_cast<std::size_t>(GetParam())]);
}

INSTANTIATE_TEST_SUITE_P(All, EstimatorsAgree, testing::Range(0, static_cast<int>(comparisons().size())),
                         [](const auto& test) {
                             return test_name(comparisons()[static_cast<std::size_t>(test.param)]);
                         });

// An anti-aliased pixel is the mean over its square: that of a view with 8 x 8 as many pixels, where nothing has an
// edge within a pixel. The midpoint rule errs by f'' h^2 / 24: light that falls off over half a metre (f'' = 20 f at
// most) and a grid of h = 2 cm make it 3e-4 of the value.
TEST(Antialiasing, ConvergesToAFineGridOfCentreRays) {
    constexpr int grid = 8;
    constexpr double tolerance = 3e-4;
    for (const Setting& setting : {glancing_light(), small_light()}) {
        const PathTracer tracer(setting.scene);
        const View fine(setting.view.camera(), grid * setting.view.width(), grid * setting.view.height());
        Replicates spread, centres;
        for (std::uint64_t seed = 0; seed < 16; ++seed) {
            auto settings = settings_for({"direct"}, 2048);
            settings.seed = 100 + seed, settings.antialias = true;
            spread.add(tracer.render(setting.view, settings).frame.plane("direct"));
            settings = settings_for({"direct"}, 2048 / grid / grid);
            settings.seed = 200 + seed;
            const Frame frame = tracer.render(fine, settings).frame;
            Image mean(setting.view.width(), setting.view.height(), 3);
            for (int y = 0; y < fine.height(); ++y) {
                for (int x = 0; x < fine.width(); ++x) {
                    for (int c = 0; c < 3; ++c) {
                        mean.at(x / grid, y / grid, c) += frame.plane("direct").at(x, y, c) / (grid * grid);
                    }
                }
            }
            centres.add(mean);
        }
        expect_agreement(spread, centres, setting.name, tolerance);
    }
}

// What an edge leaves of a pixel is its area. A glowing triangle that faces the camera is cut to each pixel's square.
TEST(Antialiasing, GivesEachPixelTheShareOfItsAreaThatIsCovered) {
    const closed_form::Polygon corners = {{-0.35, -0.3, -1}, {0.4, -0.17, -1}, {0.05, 0.37, -1}};
    Scene scene;
    add_polygon(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(1.0f)), corners);
    const View view = view_of({0, 0, 0}, {0, 0, -1}, 2.0f * std::atan(0.5f), 8);  // sees |x|, |y| <= 0.5 at z = -1
    Image covered(8, 8, 3);
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
            const glm::dvec3 lower(x / 8.0 - 0.5, 0.5 - (y + 1) / 8.0, 0), upper = lower + glm::dvec3(0.125, 0.125, 0);
            closed_form::Polygon rest = corners;
            rest = closed_form::clipped_to_horizon(rest, lower, {1, 0, 0});
            rest = closed_form::clipped_to_horizon(rest, lower, {0, 1, 0});
            rest = closed_form::clipped_to_horizon(rest, upper, {-1, 0, 0});
            rest = closed_form::clipped_to_horizon(rest, upper, {0, -1, 0});
            double area = 0.0;
            for (std::size_t i = 2; i < rest.size(); ++i) {
                area += 0.5 * glm::cross(rest[i - 1] - rest[0], rest[i] - rest[0]).z;
            }
            for (int c = 0; c < 3; ++c) covered.at(x, y, c) = static_cast<float>(64.0 * area);
        }
    }
    Replicates expected, rendered;
    const PathTracer tracer(scene);
    for (std::uint64_t seed = 0; seed < 16; ++seed) {
        auto settings = settings_for({"emission"}, 256);
        settings.seed = seed, settings.antialias = true;
        rendered.add(tracer.render(view, settings).frame.plane("emission"));
        expected.add(covered);
    }
    expect_agreement(rendered, expected, "coverage");
}

}  // namespace
}  // namespace plumb

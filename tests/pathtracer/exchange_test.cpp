// Light exchanged between two squares, averaged over exactly one of them, against the view-factor catalogue.
//
// A pinhole camera that faces a square maps its pixels to an even grid on it: where the square fills the view, the mean
// of an anti-aliased image is the mean over the square.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/pathtracer/closed_forms.h"
#include "tests/pathtracer/test_scenes.h"

namespace plumb {
namespace {

using closed_form::pi;

// The view that the unit square around `centre` fills exactly, from `distance` in front of it.
View view_of_square(const glm::vec3& centre, const glm::vec3& normal, float distance, const glm::vec3& up) {
    return view_of(centre + distance * normal, centre, 2.0f * std::atan(0.5f / distance), 16, up);
}

Frame render(const Scene& scene, const View& view, int samples, EmitterSampling sampling = EmitterSampling::both) {
    auto settings = settings_for({"direct", "indirect.1", "indirect.2"}, samples, 2);
    settings.antialias = true;
    settings.emitter_sampling = sampling;
    return PathTracer(scene).render(view, settings).frame;
}

void expect_black(const Frame& frame, const std::string& plane) {
    for (const float value : frame.plane(plane).values()) ASSERT_EQ(value, 0.0f) << plane;
}

class ExchangeBySampling : public testing::TestWithParam<EmitterSampling> {};

constexpr float lower_albedo = 0.7f, upper_albedo = 0.4f, emission = 3.0f;
const glm::dvec3 colour(1.0, 0.5, 2.0);  // of the emission

// Directly opposed unit squares at distance 0.5, of which the upper one emits. With the point view factor f(p) from one
// square to the other and the kernel k(p, q) = c^2 / (pi d^4), whose integral over q is f(p):
//   lower square, direct:      albedo Le * mean of f                                 (the catalogue's C-11)
//   upper square, indirect.1:  albedo^2 Le * mean of (integral of k f) = mean of f^2  (k is symmetric)
//   lower square, indirect.2:  albedo^3 Le * double integral of f k f
TEST_P(ExchangeBySampling, BetweenParallelSquaresFollowsTheirViewFactor) {
    constexpr double distance = 0.5;
    const closed_form::Polygon lower = {{-0.5, 0, 0.5}, {0.5, 0, 0.5}, {0.5, 0, -0.5}, {-0.5, 0, -0.5}};
    closed_form::Polygon upper = lower;
    for (glm::dvec3& corner : upper) corner.y = distance;
    Scene scene;
    add_polygon(scene, add_material(scene, glm::vec3(lower_albedo)), lower);
    add_polygon(scene, add_material(scene, glm::vec3(upper_albedo), emission * glm::vec3(colour)), upper);

    constexpr int steps = 64;  // midpoint rule; that it gives C-11 to within 2e-4 is checked below
    std::vector<glm::dvec2> points;
    std::vector<double> factors;
    double mean = 0.0, mean_square = 0.0, chain = 0.0;
    for (int i = 0; i < steps * steps; ++i) {
        const int row = i / steps, column = i % steps;
        points.emplace_back((column + 0.5) / steps - 0.5, (row + 0.5) / steps - 0.5);
        const glm::dvec3 point(points.back().x, 0.0, points.back().y);
        factors.push_back(closed_form::polygon_irradiance(point, {0, 1, 0}, upper) / pi);
        mean += factors.back() / (steps * steps), mean_square += factors.back() * factors.back() / (steps * steps);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t j = 0; j < points.size(); ++j) {
            const glm::dvec2 across = points[i] - points[j];
            const double squared = distance * distance + glm::dot(across, across);
            chain += factors[i] * factors[j] / (squared * squared);
        }
    }
    chain *= distance * distance / pi / std::pow(steps, 4);
    const double catalogue = closed_form::parallel_rectangles(1.0, 1.0, distance);
    ASSERT_NEAR(mean, catalogue, 2e-4 * catalogue);

    const Frame below = render(scene, view_of_square({0, 0, 0}, {0, 1, 0}, 0.25f, {0, 0, -1}), 2048, GetParam());
    expect_mean(below, "direct", lower_albedo * emission * catalogue, "", 0.0, 0.01, colour);
    expect_black(below, "indirect.1");
    // 3 %: most paths leave the open squares before their third segment; 1 % would take nine times as many.
    expect_mean(below, "indirect.2", lower_albedo * upper_albedo * lower_albedo * emission * chain, "", 2e-4, 0.03,
                colour);
    const Frame above = render(scene, view_of_square({0, 0.5f, 0}, {0, -1, 0}, 0.25f, {0, 0, -1}), 2048, GetParam());
    expect_black(above, "direct");
    expect_mean(above, "indirect.1", upper_albedo * lower_albedo * emission * mean_square, "", 2e-4, 0.01, colour);
    expect_black(above, "indirect.2");
}

// A wall and a floor with a common edge. Light parallel to the floor gives the wall an even irradiance E and the floor
// none, so that the floor's indirect.1 is albedo^2 E / pi times C-14, and the wall's indirect.2, after wall, floor and
// wall, albedo^3 E / pi times the mean of the floor's squared point view factor.
TEST(Exchange, OfAWallAndAFloorFollowsTheirViewFactor) {
    constexpr float floor_albedo = lower_albedo, wall_albedo = upper_albedo, irradiance = 5.0f;
    const closed_form::Polygon floor = {{0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0}};
    const closed_form::Polygon wall = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
    Scene scene;
    add_polygon(scene, add_material(scene, glm::vec3(floor_albedo)), floor);
    add_polygon(scene, add_material(scene, glm::vec3(wall_albedo)), wall);
    scene.directional_lights.push_back({"sun", {-1.0f, 0.0f, 0.0f}, glm::vec3(irradiance)});

    constexpr int steps = 400;  // as in ClosedForm.ViewFactorsOfRectanglesAreMeansOfPointViewFactors: 1e-5
    double mean_square = 0.0;
    for (int i = 0; i < steps * steps; ++i) {
        const int row = i / steps, column = i % steps;
        const glm::dvec3 point((column + 0.5) / steps, 0.0, (row + 0.5) / steps);
        const double factor = closed_form::polygon_irradiance(point, {0, 1, 0}, wall) / pi;
        mean_square += factor * factor / (steps * steps);
    }
    const double catalogue = closed_form::perpendicular_rectangles(1.0, 1.0, 1.0);

    const Frame below = render(scene, view_of_square({0.5f, 0, 0.5f}, {0, 1, 0}, 0.5f, {0, 0, -1}), 1024);
    expect_black(below, "direct");
    expect_mean(below, "indirect.1", floor_albedo * wall_albedo * irradiance / pi * catalogue);
    expect_black(below, "indirect.2");
    const Frame beside = render(scene, view_of_square({0, 0.5f, 0.5f}, {1, 0, 0}, 0.5f, {0, 1, 0}), 8192);
    expect_mean(beside, "direct", wall_albedo * irradiance / pi);
    expect_black(beside, "indirect.1");
    expect_mean(beside, "indirect.2", wall_albedo * floor_albedo * wall_albedo * irradiance / pi * mean_square, "",
                1e-4);
}

INSTANTIATE_TEST_SUITE_P(All, ExchangeBySampling,
                         testing::Values(EmitterSampling::lights, EmitterSampling::directions, EmitterSampling::both));

}  // namespace
}  // namespace plumb

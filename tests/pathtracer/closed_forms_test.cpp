// The formulas of closed_forms.h against brute force: plain sums over areas or over directions.
#include "tests/pathtracer/closed_forms.h"

#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace plumb {
namespace {

using namespace closed_form;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Falloff falloffs[] = {Falloff::hard, Falloff::quadratic, Falloff::cubic};

// Irradiance by summing over a fan of triangles, each cut into steps^2 small ones.
double summed_irradiance(const glm::dvec3& point, const glm::dvec3& normal, const Polygon& polygon, int steps) {
    double sum = 0.0;
    for (std::size_t corner = 2; corner < polygon.size(); ++corner) {
        const glm::dvec3 u = (polygon[corner - 1] - polygon[0]) / static_cast<double>(steps);
        const glm::dvec3 v = (polygon[corner] - polygon[0]) / static_cast<double>(steps);
        const glm::dvec3 area = 0.5 * glm::cross(u, v);
        const auto add = [&](double i, double j) {
            const glm::dvec3 offset = polygon[0] + i * u + j * v - point;
            const double squared = glm::dot(offset, offset);
            const double cosine = std::max(0.0, glm::dot(normal, offset));
            sum += cosine * std::abs(glm::dot(area, offset)) / (squared * squared);
        };
        for (int i = 0; i < steps; ++i) {
            for (int j = 0; i + j < steps; ++j) {
                add(i + 1.0 / 3.0, j + 1.0 / 3.0);
                if (i + j + 1 < steps) add(i + 2.0 / 3.0, j + 2.0 / 3.0);
            }
        }
    }
    return sum;
}

// Obscurance by summing over cosine-distributed directions: a grid of midpoints in the unit disc. `hit` gives the
// distance to what a direction (u, v across, w up) meets. The grid is turned, so that no straight edge runs along it;
// edges then err by about (1 / steps)^1.5 = 3e-5.
double summed_obscurance(const std::function<double(double u, double v, double w)>& hit, double radius, Falloff kind) {
    constexpr int steps = 1000;
    const double cosine = std::cos(0.6), sine = std::sin(0.6);
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const double s = (2 * i + 1.0) / steps - 1.0, t = (2 * j + 1.0) / steps - 1.0, squared = s * s + t * t;
            if (squared >= 1.0) continue;
            sum += falloff(kind, hit(cosine * s - sine * t, sine * s + cosine * t, std::sqrt(1.0 - squared)), radius);
        }
    }
    return sum * 4.0 / (pi * steps * steps);
}
constexpr double sum_error = 1e-4;  // three times the above

void expect_obscurance(const std::function<double(double radius, Falloff kind)>& formula,
                       const std::function<double(double u, double v, double w)>& hit,
                       const std::vector<double>& radii) {
    for (const double radius : radii) {
        for (const Falloff kind : falloffs) {
            EXPECT_NEAR(formula(radius, kind), summed_obscurance(hit, radius, kind), sum_error)
                << "radius " << radius << ", falloff " << to_string(kind);
        }
    }
}

TEST(ClosedForm, IrradianceUnderAPolygonIsItsIntegral) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.2, 1.0, -0.1));
    const std::vector<Polygon> polygons = {
        {{0, 1, 0}, {1, 1.4, 0}, {0.3, 1.1, 1}},                                            // tilted triangle
        {{-1, 0.7, -1}, {-1, 0.7, 1}, {1, 0.7, 1}, {1, 0.7, -1}},                           // square overhead
        {{2, -1, -1}, {2, -1, 1}, {2, 1.5, 1}, {2, 1.5, -1}},                               // cut by the horizon
        {{1, 0.5, 0}, {0.5, 0.7, 0.9}, {-0.5, 0.7, 0.9}, {-1, 0.5, 0}, {-0.4, 0.3, -0.7}},  // nearly flat pentagon
        {{1, -2, 0}, {1, -2, 1}, {2, -2, 0}}};                                              // below the horizon
    for (const Polygon& polygon : polygons) {
        const glm::dvec3 point(0.1, -0.2, 0.15);
        // 1e-4: a thousandth of the horizon's cut through a row of 600 small triangles, and far below that elsewhere.
        // The pentagon is not quite flat: both sum over the same fan only if the formula is given the same triangles.
        double expected = 0.0;
        for (std::size_t i = 2; i < polygon.size(); ++i) {
            expected += polygon_irradiance(point, normal, {polygon[0], polygon[i - 1], polygon[i]});
        }
        EXPECT_NEAR(expected, summed_irradiance(point, normal, polygon, 600), 1e-4);
        if (polygon.size() == 4) {
            EXPECT_NEAR(polygon_irradiance(point, normal, polygon), expected, 1e-12);
        }
    }
}

TEST(ClosedForm, ViewFactorsOfRectanglesAreMeansOfPointViewFactors) {
    const auto mean_over_floor = [](double width, double length, const Polygon& seen) {
        constexpr int steps = 400;
        double sum = 0.0;
        for (int i = 0; i < steps; ++i) {
            for (int j = 0; j < steps; ++j) {
                const glm::dvec3 point(width * (i + 0.5) / steps, 0.0, length * (j + 0.5) / steps);
                sum += polygon_irradiance(point, {0, 1, 0}, seen) / pi;
            }
        }
        return sum / (steps * steps);
    };
    // 1e-5: the midpoint rule with 400 steps; at the common edge the integrand has a kink of finite slope.
    for (const glm::dvec3 size : {glm::dvec3(1, 1, 1), glm::dvec3(1, 2, 0.7), glm::dvec3(0.5, 0.8, 2)}) {
        const double a = size.x, b = size.y, c = size.z;
        EXPECT_NEAR(parallel_rectangles(a, b, c), mean_over_floor(a, b, {{0, c, 0}, {a, c, 0}, {a, c, b}, {0, c, b}}),
                    1e-5);
        EXPECT_NEAR(perpendicular_rectangles(a, c, b),
                    mean_over_floor(a, b, {{0, 0, 0}, {0, c, 0}, {0, c, b}, {0, 0, b}}), 1e-5);
    }
    // The catalogue's numbers for a cube; all of what leaves one face arrives at the five others.
    EXPECT_NEAR(parallel_rectangles(1, 1, 1), 0.19982, 1e-5);
    EXPECT_NEAR(parallel_rectangles(1, 1, 1) + 4.0 * perpendicular_rectangles(1, 1, 1), 1.0, 1e-12);
}

TEST(ClosedForm, ObscuranceBesideAnEndlessWallIsItsIntegral) {
    const double a = 0.7;
    expect_obscurance([&](double radius, Falloff kind) { return endless_wall(a, radius, kind); },
                      [&](double u, double, double) { return u > 0.0 ? a / u : infinity; }, {0.5, 0.8, 2.0, infinity});
}

TEST(ClosedForm, ObscuranceInACornerIsItsIntegral) {
    const double a = 0.7, b = 0.4;
    expect_obscurance(
        [&](double radius, Falloff kind) { return corner_of_two_walls(a, b, radius, kind); },
        [&](double u, double v, double) { return std::min(u > 0.0 ? a / u : infinity, v > 0.0 ? b / v : infinity); },
        {0.5, 0.75, 1.0, 3.0, infinity});
}

TEST(ClosedForm, ObscuranceBesideAWallOfFiniteHeightIsItsIntegral) {
    const double a = 0.5, h = 0.8;
    expect_obscurance([&](double radius, Falloff kind) { return wall_of_height(a, h, radius, kind); },
                      [&](double u, double, double w) { return u > 0.0 && w * a / u < h ? a / u : infinity; },
                      {0.4, 0.6, 1.2, 4.0, infinity});
}

TEST(ClosedForm, ObscuranceUnderADiscIsItsIntegral) {
    const double r = 0.6, h = 0.5;
    for (const double a : {0.0, 0.3, 0.6, 1.1}) {
        expect_obscurance(
            [&](double radius, Falloff kind) { return under_disc(r, h, a, radius, kind); },
            [&](double u, double v, double w) { return std::hypot(u * h / w - a, v * h / w) < r ? h / w : infinity; },
            {0.4, 0.7, 1.5, infinity});
    }
    // The two ways of writing what lies straight above agree where one becomes the other.
    for (const Falloff kind : falloffs) {
        EXPECT_NEAR(under_disc(r, h, 1e-9, 0.7, kind), under_disc(r, h, 0.0, 0.7, kind), 1e-6);
    }
}

}  // namespace
}  // namespace plumb

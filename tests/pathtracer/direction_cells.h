// Cells of the sphere of directions, and the integral of a density over each.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "pathtracer/direction_sampling.h"

namespace plumb {

// Integral over [x0, x1] x [y0, y1] by Gauss's rule of 4 x 4 points, halved on both axes until the four quarters agree
// with the whole; a jump within the domain costs depth, not accuracy.
template <typename Function>
double integrate_square(const Function& function, double x0, double x1, double y0, double y1, double tolerance,
                        int deepest = 8) {
    static constexpr double points[4] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                         0.9305681557970263};
    static constexpr double weights[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                          0.17392742256872693};
    const auto rule = [&](double a0, double a1, double b0, double b1) {
        double sum = 0.0;
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 4; ++j) {
                sum += weights[i] * weights[j] * function(a0 + (a1 - a0) * points[i], b0 + (b1 - b0) * points[j]);
            }
        }
        return sum * (a1 - a0) * (b1 - b0);
    };
    struct Part {
        double x0, x1, y0, y1, integral;
        int depth;
    };
    double total = 0.0;
    std::vector<Part> open = {{x0, x1, y0, y1, rule(x0, x1, y0, y1), 0}};
    while (!open.empty()) {
        const Part part = open.back();
        open.pop_back();
        const double xm = 0.5 * (part.x0 + part.x1), ym = 0.5 * (part.y0 + part.y1);
        Part quarters[4] = {{part.x0, xm, part.y0, ym, 0.0, part.depth + 1},
                            {xm, part.x1, part.y0, ym, 0.0, part.depth + 1},
                            {part.x0, xm, ym, part.y1, 0.0, part.depth + 1},
                            {xm, part.x1, ym, part.y1, 0.0, part.depth + 1}};
        double sum = 0.0;
        for (Part& quarter : quarters) {
            quarter.integral = rule(quarter.x0, quarter.x1, quarter.y0, quarter.y1);
            sum += quarter.integral;
        }
        const double difference = std::abs(sum - part.integral);
        // Parts share the tolerance by area, but a jump may use it up along its line. A part that is right to 1e-4 is
        // right enough: that moves the statistic of 4 million samples by 0.04.
        const double allowed = tolerance * std::pow(0.5, part.depth) + 1e-4 * std::abs(sum);
        if (part.depth >= deepest || (part.depth > 0 && difference <= allowed)) {
            total += sum;
        } else {
            open.insert(open.end(), quarters, quarters + 4);
        }
    }
    return total;
}

// Which eighth of a full turn, counted from the positive x axis, the point lies in; without trigonometry or branches.
inline int octant(double x, double y) {
    static constexpr int octants[8] = {0, 1, 3, 2, 7, 6, 4, 5};
    return octants[(std::abs(y) > std::abs(x) ? 1 : 0) + (x < 0.0 ? 2 : 0) + (y < 0.0 ? 4 : 0)];
}

// Integrals of a function of the azimuth in [0, 2 pi) and of a second coordinate in [0, 1), over 8 octants times `rows`
// equal parts; cell row * 8 + octant. The function is 0 from last(azimuth) on, where it may jump. It may change fast
// about a quarter and three quarters of a turn, where the octants are cut into ever thinner strips.
template <typename Function, typename Last>
std::vector<double> integrate_octants(int rows, const Function& function, const Last& last) {
    std::vector<double> result;
    for (int row = 0; row < rows; ++row) {
        const double from = static_cast<double>(row) / rows, to = static_cast<double>(row + 1) / rows;
        const auto stretched = [&](double azimuth, double part) {
            const double length = std::clamp(last(azimuth), from, to) - from;
            return length > 0.0 ? length * function(azimuth, from + length * part) : 0.0;
        };
        for (int column = 0; column < 8; ++column) {
            const double width = glm::quarter_pi<double>(), first = width * column;
            const bool ends_fast = column % 4 == 1, starts_fast = column % 4 == 2;
            double sum = 0.0, outer = 1.0;  // in units of the width, from the fast end
            for (int strip = 0; strip < (ends_fast || starts_fast ? 12 : 0); ++strip, outer *= 0.5) {
                const double a = starts_fast ? 0.5 * outer : 1.0 - outer, b = starts_fast ? outer : 1.0 - 0.5 * outer;
                sum += integrate_square(stretched, first + width * a, first + width * b, 0.0, 1.0, 1e-8);
            }
            const double a = ends_fast ? 1.0 - outer : 0.0, b = starts_fast ? outer : 1.0;
            result.push_back(sum + integrate_square(stretched, first + width * a, first + width * b, 0.0, 1.0, 1e-7));
        }
    }
    return result;
}

// The sphere about an axis: octants of azimuth times rows of equal solid angle from the axis to its opposite.
class DirectionCells {
public:
    DirectionCells(const glm::vec3& axis, int rows) : axis_(axis), rows_(rows) {
        complete_basis(axis, tangent_, bitangent_);
    }

    int cell(const glm::vec3& direction) const {
        const double s = 0.5 - 0.5 * glm::dot(direction, axis_);
        return 8 * std::clamp(static_cast<int>(s * rows_), 0, rows_ - 1) +
               octant(glm::dot(direction, tangent_), glm::dot(direction, bitangent_));
    }

    // Of a density per solid angle.
    template <typename Density>
    std::vector<double> integrals(const Density& density) const {
        const auto integrand = [&](double azimuth, double s) {
            const double sine = 2.0 * std::sqrt(s * (1.0 - s));
            const glm::dvec3 direction = sine * std::cos(azimuth) * glm::dvec3(tangent_) +
                                         sine * std::sin(azimuth) * glm::dvec3(bitangent_) +
                                         (1.0 - 2.0 * s) * glm::dvec3(axis_);
            return 2.0 * static_cast<double>(density(glm::vec3(direction)));  // solid angle = 2 d(azimuth) ds
        };
        return integrate_octants(rows_, integrand, [](double) { return 1.0; });
    }

private:
    glm::vec3 axis_, tangent_{0.0f}, bitangent_{0.0f};
    int rows_;
};

// Cells of directions wi that suit a specular lobe, however narrow and however grazing: those of the half vector h =
// normalize(wo + wi), whose slope against the normal is counted in units of alpha. Octants of the slope's azimuth from
// the plane of incidence times rows of y = 1 - cos(atan(slope / alpha)), in which a lobe has no poles.
class HalfVectorCells {
public:
    HalfVectorCells(const glm::dvec3& normal, const glm::dvec3& tangent, const glm::dvec3& wo, double alpha, int rows)
        : normal_(normal),
          tangent_(tangent),
          bitangent_(glm::cross(normal, tangent)),
          wo_(wo),
          alpha_(alpha),
          rows_(rows) {}

    int cell(const glm::vec3& wi) const {
        const glm::dvec3 sum = wo_ + glm::dvec3(wi);
        const double x = glm::dot(sum, tangent_), y = glm::dot(sum, bitangent_), z = alpha_ * glm::dot(sum, normal_);
        const double row = 1.0 - z / std::sqrt(x * x + y * y + z * z);
        return 8 * std::clamp(static_cast<int>(row * rows_), 0, rows_ - 1) + octant(x, y);
    }

    template <typename Density>
    std::vector<double> integrals(const Density& density) const {
        const auto integrand = [&](double azimuth, double y) {
            const double q = 1.0 - y, slope = alpha_ * std::sqrt(1.0 - q * q) / q;
            const glm::dvec3 h =
                glm::normalize(normal_ + slope * (std::cos(azimuth) * tangent_ + std::sin(azimuth) * bitangent_));
            const double cosine = glm::dot(wo_, h), cosine_h = glm::dot(normal_, h);
            if (!(cosine > 0.0)) return 0.0;
            const glm::dvec3 wi = 2.0 * cosine * h - wo_;
            // Solid angle of wi per that of h, that per area of slopes, that per azimuth and y.
            const double jacobian = 4.0 * cosine * cosine_h * cosine_h * cosine_h * alpha_ * alpha_ / (q * q * q);
            return jacobian * static_cast<double>(density(glm::vec3(wi)));
        };
        // wi reaches the horizon at the slope t where 2 (wo.h) (n.h) = n.wo, that is c + 2 a t - c t^2 = 0, c the
        // cosine of wo and a its part along the azimuth.
        const auto horizon = [&](double azimuth) {
            const double c = glm::dot(normal_, wo_), a = std::cos(azimuth) * glm::dot(tangent_, wo_);
            const double root = std::sqrt(a * a + c * c), t = (a > 0.0 ? (a + root) / c : c / (root - a)) / alpha_;
            return 1.0 - 1.0 / std::sqrt(1.0 + t * t);
        };
        return integrate_octants(rows_, integrand, horizon);
    }

private:
    glm::dvec3 normal_, tangent_, bitangent_, wo_;
    double alpha_;
    int rows_;
};

}  // namespace plumb

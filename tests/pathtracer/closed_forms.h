// Closed forms (or one-dimensional integrals) of light transport, which the path tracer is held against: irradiance
// under polygons, view factors, ambient visibility with its falloffs. Each formula is itself compared with brute-force
// quadrature in closed_forms_test.cpp, which knows nothing of the derivations.
//
// All in double; lengths in metres. "Obscurance" is 1 - ambient visibility.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <glm/glm.hpp>

#include "frames/quantities.h"

namespace plumb::closed_form {

using std::numbers::pi;
using Polygon = std::vector<glm::dvec3>;

// Midpoint rule. With the default number of steps the error is below 1e-7 for every integrand here, also at the kinks
// where a radius or a wall's edge cuts in.
inline double integrate(const std::function<double(double)>& f, double from, double to, int steps = 20000) {
    const double step = (to - from) / steps;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) sum += f(from + (i + 0.5) * step);
    return sum * step;
}

// The part of a convex polygon above the plane through `point` with `normal`.
//   Source: Sutherland, Hodgman 1974, "Reentrant Polygon Clipping".
inline Polygon clipped_to_horizon(const Polygon& polygon, const glm::dvec3& point, const glm::dvec3& normal) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double height_a = glm::dot(a - point, normal), height_b = glm::dot(b - point, normal);
        if (height_a >= 0.0) kept.push_back(a);
        if (height_a * height_b < 0.0) kept.push_back(a + (b - a) * (height_a / (height_a - height_b)));
    }
    return kept;
}

// Irradiance at `point` with unit `normal` under a convex polygon of radiance 1 on both sides, whatever part of it is
// above the horizon.
//   Source: Lambert 1760, "Photometria"; as in Baum et al. 1989, "Improving Radiosity Solutions Through the Use of
//   Analytically Determined Form-Factors": half the sum over edges of (angle the edge subtends) * (unit normal of the
//   plane through the edge and the point . normal).
inline double polygon_irradiance(const glm::dvec3& point, const glm::dvec3& normal, const Polygon& polygon) {
    const Polygon visible = clipped_to_horizon(polygon, point, normal);
    double sum = 0.0;
    for (std::size_t i = 0; i < visible.size(); ++i) {
        const glm::dvec3 a = glm::normalize(visible[i] - point);
        const glm::dvec3 b = glm::normalize(visible[(i + 1) % visible.size()] - point);
        const glm::dvec3 across = glm::cross(a, b);
        const double sine = glm::length(across);
        if (sine > 0.0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(across, normal) / sine;
    }
    return 0.5 * std::abs(sum);
}

// View factor between two parallel, directly opposed rectangles a x b at distance c.
//   Source: Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11.
inline double parallel_rectangles(double a, double b, double c) {
    const double x = a / c, y = b / c, x1 = 1.0 + x * x, y1 = 1.0 + y * y;
    return 2.0 / (pi * x * y) *
           (0.5 * std::log(x1 * y1 / (x1 + y * y)) + x * std::sqrt(y1) * std::atan(x / std::sqrt(y1)) +
            y * std::sqrt(x1) * std::atan(y / std::sqrt(x1)) - x * std::atan(x) - y * std::atan(y));
}

// View factor from a rectangle w x l to one of h x l at right angles, with the edge l in common.
//   Source: Howell, C-14.
inline double perpendicular_rectangles(double w, double h, double l) {
    const double W = w / l, H = h / l, w2 = W * W, h2 = H * H, both = 1.0 + w2 + h2;
    const double logarithm = std::log((1.0 + w2) * (1.0 + h2) / both) +
                             w2 * std::log(w2 * both / ((1.0 + w2) * (w2 + h2))) +
                             h2 * std::log(h2 * both / ((1.0 + h2) * (w2 + h2)));
    const double diagonal = std::sqrt(h2 + w2);
    return (W * std::atan(1.0 / W) + H * std::atan(1.0 / H) - diagonal * std::atan(1.0 / diagonal) + 0.25 * logarithm) /
           (pi * W);
}

// View factor from a small plane element to a disc of radius r in a parallel plane at height h, whose centre is shifted
// sideways by a.
//   Source: Howell, B-13, multiplied by a^2 inside so that a = 0 gives B-12, r^2 / (r^2 + h^2).
inline double shifted_disc(double r, double h, double a) {
    const double z = a * a + h * h + r * r;
    return 0.5 * (1.0 - (z - 2.0 * r * r) / std::sqrt(z * z - 4.0 * a * a * r * r));
}

inline double falloff(Falloff kind, double distance, double radius) {
    if (distance >= radius) return 0.0;
    const double t = std::isinf(radius) ? 1.0 : 1.0 - distance * distance / (radius * radius);
    return kind == Falloff::hard ? 1.0 : kind == Falloff::quadratic ? t : t * t * t;
}

// Obscurance on a floor at distance a from an endless, endlessly high wall.
//   Derivation: a direction whose component towards the wall is w meets it at distance a / w. Cosine-distributed
//   directions are uniform over the unit disc (Nusselt 1928), where w is one coordinate: with q = a / r
//       (1 / pi) * integral over w from q to 1 of 2 sqrt(1 - w^2) g(a / w),
//   and powers of q / w integrate with t = sqrt(1 - w^2) / w, for which sqrt(1 - w^2) dw = -t^2 w^4 dt.
inline double endless_wall(double a, double radius, Falloff kind) {
    const double q = std::isinf(radius) ? 0.0 : a / radius;
    if (q >= 1.0) return 0.0;
    const double s = std::sqrt(1.0 - q * q), segment = std::acos(q) - q * s;
    if (q == 0.0 || kind == Falloff::hard) return segment / pi;
    const double t = s / q, q2 = q * q;
    const double second = 2.0 * (t - std::atan(t));  // of 2 sqrt(1 - w^2) / w^2, and so on
    if (kind == Falloff::quadratic) return (segment - q2 * second) / pi;
    const double fourth = 2.0 / 3.0 * t * t * t, sixth = fourth + 0.4 * t * t * t * t * t;
    return (segment - 3.0 * q2 * second + 3.0 * q2 * q2 * fourth - q2 * q2 * q2 * sixth) / pi;
}

// Obscurance on a floor in the corner of two endless walls at distances a and b.
//   Derivation: as above, the unit disc's coordinates u and v being the components towards the walls. The nearer hit
//   counts: where a / u < b / v the first wall. In polar coordinates (p, phi) of the disc it is the first wall up to
//   the angle of the corner's edge, phi = atan2(b, a), and a sector contributes
//       (1 / pi) * integral over phi of integral over p from 0 to 1 of g(a / (p cos(phi))) p.
//   The inner integral is closed: with m = a / (r cos(phi)) < 1 it is (1 - m^2) / 2 for a hard cut; and of 1 - m^2 /
//   p^2 and its cube as below. Away from the corner's edge the first sector reaches to where its wall ends, at -90
//   degrees.
inline double corner_of_two_walls(double a, double b, double radius, Falloff kind) {
    if (std::isinf(radius)) return 0.75;
    const auto sector = [&](double distance, double from, double to) {
        return integrate(
            [&](double phi) {
                const double m = distance / (radius * std::cos(phi)), m2 = m * m;
                if (!(m > 0.0 && m < 1.0)) return 0.0;
                const double hard = 0.5 * (1.0 - m2), second = -std::log(m);  // of p and 1 / p
                if (kind == Falloff::hard) return hard;
                if (kind == Falloff::quadratic) return hard - m2 * second;
                const double fourth = 0.5 * (1.0 / m2 - 1.0), sixth = 0.25 * (1.0 / (m2 * m2) - 1.0);
                return hard - 3.0 * m2 * second + 3.0 * m2 * m2 * fourth - m2 * m2 * m2 * sixth;
            },
            from, to);
    };
    const double edge = std::atan2(b, a);
    return (sector(a, -0.5 * pi, edge) + sector(b, -0.5 * pi, 0.5 * pi - edge)) / pi;
}

// Obscurance on a floor at distance a from an endless wall of height h: the integral of
// g(d) cos(theta) cos(theta') / (pi d^2) over the wall, in polar coordinates around the wall's point nearest to the
// receiver. On the arc of radius p the height is p sin(phi), whose integral over the arc below the wall's edge is
// p * (2 - 2 sqrt(1 - h^2 / p^2)), or 2 p where all of the half circle is below.
inline double wall_of_height(double a, double h, double radius, Falloff kind) {
    if (std::isinf(radius)) return 0.5 * (1.0 - a / std::hypot(a, h));  // Howell, B-3
    if (a >= radius) return 0.0;
    return integrate(
               [&](double p) {
                   const double arc = p <= h ? 2.0 : 2.0 - 2.0 * std::sqrt(1.0 - h * h / (p * p));
                   const double squared = a * a + p * p;
                   return falloff(kind, std::sqrt(squared), radius) * a * p * p / (squared * squared) * arc;
               },
               0.0, std::sqrt(radius * radius - a * a)) /
           pi;
}

// Obscurance under a disc of radius r at height h, its centre shifted sideways by a: rings of radius p around the point
// straight above, of which the disc covers the angle 2 acos((p^2 + a^2 - r^2) / (2 p a)).
inline double under_disc(double r, double h, double a, double radius, Falloff kind) {
    if (std::isinf(radius)) return shifted_disc(r, h, a);
    if (h >= radius) return 0.0;
    if (a == 0.0) {
        // In terms of w = cos(theta), from the disc's rim or the radius to straight up, density 2 w dw, d = h / w.
        const double q2 = h * h / (radius * radius), m2 = std::max(h * h / (r * r + h * h), q2);
        const double hard = 1.0 - m2, second = -std::log(m2);
        if (kind == Falloff::hard) return hard;
        if (kind == Falloff::quadratic) return hard - q2 * second;
        return hard - 3.0 * q2 * second + 3.0 * q2 * q2 * (1.0 / m2 - 1.0) -
               0.5 * q2 * q2 * q2 * (1.0 / (m2 * m2) - 1.0);
    }
    return integrate(
               [&](double p) {
                   const double squared = h * h + p * p;
                   const double cosine = std::clamp((p * p + a * a - r * r) / (2.0 * p * a), -1.0, 1.0);
                   return falloff(kind, std::sqrt(squared), radius) * h * h / (squared * squared) * 2.0 *
                          std::acos(cosine) * p;
               },
               0.0, std::min(a + r, std::sqrt(radius * radius - h * h))) /
           pi;
}

}  // namespace plumb::closed_form

// The shadow maps of a lamp that shines all around, as rays make them, and how a receiver is looked up in them: texel
// by texel, in double precision, from what rasterizer/shadow_pass.h and rasterizer/shadow_lookup.glsl say in words.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "ray_caster.h"

namespace plumb::counterpart {

// How much of a lamp a point receives; none where the four texels do not all lie on one part of the map.
using Visibility = std::optional<double>;

// One square part of a map: for each texel how far away the first surface is, in the measure that is compared.
class TracedTexels {
public:
    // `trace` gives that distance for a place in [-1, 1]^2; row 0 is the lowest.
    template <class Trace>
    TracedTexels(int size, const Trace& trace) : size_(size) {
        for (int j = 0; j < size; ++j) {
            for (int i = 0; i < size; ++i)
                farthest_.push_back(trace(glm::dvec2(2.0 * (i + 0.5) / size - 1.0, 2.0 * (j + 0.5) / size - 1.0)));
        }
    }
    // The bilinear mean of four comparisons.
    Visibility lit(const glm::dvec2& place, double distance) const {
        const glm::dvec2 texel = 0.5 * (place + 1.0) * static_cast<double>(size_) - 0.5;
        const int i = static_cast<int>(std::floor(texel.x)), j = static_cast<int>(std::floor(texel.y));
        if (i < 0 || j < 0 || i + 1 >= size_ || j + 1 >= size_) return {};
        const double a = texel.x - i, b = texel.y - j;
        const auto passes = [&](int x, int y) {
            return distance <= farthest_[static_cast<std::size_t>(y) * size_ + x] ? 1.0 : 0.0;
        };
        return (1 - b) * ((1 - a) * passes(i, j) + a * passes(i + 1, j)) +
               b * ((1 - a) * passes(i, j + 1) + a * passes(i + 1, j + 1));
    }

private:
    int size_;
    std::vector<double> farthest_;
};

// The distance along `direction` (in its lengths) to the first surface; nothing nearer than a centimetre casts shadows.
inline double first_surface(const RayCaster& caster, const glm::dvec3& lamp, const glm::dvec3& direction) {
    const CastHit hit = caster.cast(lamp, direction, 0.01 / glm::length(direction), 1e3);
    return hit.hit ? hit.distance : std::numeric_limits<double>::infinity();
}

// A receiver as seen from the lamp: where it is, and its normal.
struct Receiver {
    glm::dvec3 from_lamp, normal;

    // Off its surface by the bias and by what texels of `texel` metres, seen as `slope`, call for.
    glm::dvec3 lifted(double bias, double texel, double slope) const {
        return from_lamp + normal * (bias + texel * slope);
    }
};

// A face of a cube map as the OpenGL specification has them (section 8.13, table of s_c, t_c and m_a).
struct SpecifiedFace {
    glm::dvec3 s, t, axis;
};
inline const std::vector<SpecifiedFace> specified_faces = {
    {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}}, {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
    {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};

class TracedCube {
public:
    // `linear`: distances are compared, not those along the face's axis.
    TracedCube(const RayCaster& caster, const glm::dvec3& lamp, int size, bool linear) : size_(size), linear_(linear) {
        for (const SpecifiedFace& face : specified_faces) {
            faces_.emplace_back(size, [&](const glm::dvec2& st) {
                const glm::dvec3 direction = face.axis + st.x * face.s + st.y * face.t;
                return first_surface(caster, lamp, direction) * (linear ? glm::length(direction) : 1.0);
            });
        }
    }
    Visibility lit(const Receiver& receiver, double bias) const {
        // Texels are those of the face that the receiver itself is on.
        const glm::dvec3& axis = specified_faces[face_of(receiver.from_lamp)].axis;
        const glm::dvec3 to_sides = 1.0 - glm::abs(axis);
        double slope = glm::dot(glm::abs(receiver.normal), to_sides);
        if (linear_) {
            slope += std::abs(glm::dot(receiver.normal, receiver.from_lamp)) *
                     glm::dot(glm::abs(receiver.from_lamp), to_sides) /
                     glm::dot(receiver.from_lamp, receiver.from_lamp);
        }
        const glm::dvec3 p = receiver.lifted(bias, 2.0 * glm::dot(receiver.from_lamp, axis) / size_, slope);
        const std::size_t number = face_of(p);
        const SpecifiedFace& face = specified_faces[number];
        const double along = glm::dot(p, face.axis);
        return faces_[number].lit(glm::dvec2(glm::dot(p, face.s), glm::dot(p, face.t)) / along,
                                  linear_ ? glm::length(p) : along);
    }

private:
    static std::size_t face_of(const glm::dvec3& p) {
        std::size_t best = 0;
        for (std::size_t i = 1; i < specified_faces.size(); ++i) {
            if (glm::dot(p, specified_faces[i].axis) > glm::dot(p, specified_faces[best].axis)) best = i;
        }
        return best;
    }
    int size_;
    bool linear_;
    std::vector<TracedTexels> faces_;
};

// Two paraboloids, towards +z and -z; the horizon lies two texels within the map.
class TracedParaboloids {
public:
    TracedParaboloids(const RayCaster& caster, const glm::dvec3& lamp, int size)
        : size_(size), disc_scale_(1.0 - 4.0 / size) {
        for (const double side : {1.0, -1.0}) {
            halves_.emplace_back(size, [&](const glm::dvec2& place) {
                // The paraboloid z = (1 - x^2 - y^2) / 2 reflects what comes from here along the axis.
                const glm::dvec2 disc = place / disc_scale_;
                const double square = glm::dot(disc, disc);
                const glm::dvec3 direction = glm::dvec3(2.0 * disc, side * (1.0 - square)) / (1.0 + square);
                return first_surface(caster, lamp, direction);
            });
        }
    }
    Visibility lit(const Receiver& receiver, double bias) const {
        const double distance = glm::length(receiver.from_lamp);
        const glm::dvec3 direction = receiver.from_lamp / distance;
        const double texel = 2.0 * (1.0 + std::abs(direction.z)) / (size_ * disc_scale_) * distance;
        const double n_axis = glm::dot(receiver.normal, direction);
        const glm::dvec3 p = receiver.lifted(bias, texel, std::sqrt(2.0 * std::max(0.0, 1.0 - n_axis * n_axis)));
        const double length = glm::length(p);
        const glm::dvec2 disc = glm::dvec2(p) / (length + std::abs(p.z));
        return halves_[p.z < 0.0 ? 1 : 0].lit(disc_scale_ * disc, length);
    }

private:
    int size_;
    double disc_scale_;
    std::vector<TracedTexels> halves_;
};

}  // namespace plumb::counterpart

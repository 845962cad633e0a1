// Ambient obscurance on the CPU, from the formulas of rasterizer/ambient_obscurance.h.
#pragma once

#include <limits>
#include <numbers>

#include "frames/quantities.h"
#include "rasterizer/ambient_obscurance.h"
#include "sample_spiral_counterpart.h"

namespace plumb::counterpart {

struct Visibility {
    double mean = 0.0;  // of the taps' obscurance, before the estimator's curve
    double visibility = 1.0;
    double least = 1.0, most = 1.0;  // as far as the rounding of points moves it
    bool ambiguous = false;
};

// How far float points are from where they should be, in parts of their distance from the camera: half a unit in the
// last place, 6e-8, of each of three coordinates.
constexpr double point_rounding = 1e-7;

// The nearer in depth of a pixel's neighbours along an axis; false where neither shows anything.
inline bool step_along(const Layers& layers, Pixel pixel, int dx, int dy, glm::dvec3& step) {
    const auto depth_of = [&](Pixel p) {
        const double depth = inside(layers, p) ? depth_at(layers, 0, p) : 0.0;
        return depth > 0.0 ? depth : std::numeric_limits<double>::infinity();
    };
    const Pixel ahead{pixel.x + dx, pixel.y + dy}, behind{pixel.x - dx, pixel.y - dy};
    const double centre = depth_at(layers, 0, pixel);
    // Differences of floats, as the shader takes them: the two are equal on many a plane.
    const auto to_ahead = static_cast<float>(std::abs(depth_of(ahead) - centre)),
               to_behind = static_cast<float>(std::abs(depth_of(behind) - centre));
    if (std::isinf(to_ahead) && std::isinf(to_behind)) return false;
    step = to_ahead <= to_behind ? point_at(layers, 0, ahead) - point_at(layers, 0, pixel)
                                 : point_at(layers, 0, pixel) - point_at(layers, 0, behind);
    return true;
}

struct FaceNormal {
    glm::dvec3 normal{0.0};  // none where it is 0
    bool ambiguous = false;
};

inline FaceNormal face_normal(const Layers& layers, Pixel pixel) {
    glm::dvec3 across, up;
    if (!step_along(layers, pixel, 1, 0, across) || !step_along(layers, pixel, 0, 1, up)) return {};
    const glm::dvec3 centre = point_at(layers, 0, pixel), normal = glm::normalize(glm::cross(across, up));
    // Seen edge-on, a face's side is a matter of rounding.
    return {glm::dot(normal, centre) > 0.0 ? -normal : normal,
            std::abs(glm::dot(normal, glm::normalize(centre))) < 1e-3};
}

// The derivatives of the pixel's 2 by 2, to the right and upwards whichever corner the pixel is.
inline FaceNormal derivative_normal(const Layers& layers, Pixel pixel) {
    const Pixel left{pixel.x / 2 * 2, pixel.y}, right{left.x + 1, pixel.y}, below{pixel.x, pixel.y / 2 * 2},
        above{pixel.x, below.y + 1};
    for (const Pixel& p : {left, right, below, above}) {
        if (!inside(layers, p) || depth_at(layers, 0, p) == 0.0) return {};
    }
    const glm::dvec3 normal = glm::cross(point_at(layers, 0, right) - point_at(layers, 0, left),
                                         point_at(layers, 0, above) - point_at(layers, 0, below));
    const double relative = glm::length(normal) / (6e-5 * std::pow(depth_at(layers, 0, pixel), 2.0));
    // Differences of float points, which are good to some 1e-7 of the depth, where they are 1e-3 to 1e-2 of it.
    const bool ambiguous = std::abs(relative - 1.0) < 1e-3;
    if (relative > 1.0) return {glm::dvec3(0.0), ambiguous};
    return {glm::normalize(normal), ambiguous};
}

// Of the disc that taps fall into; 0 where nothing is seen.
inline double radius_in_pixels(const Layers& layers, const AmbientObscuranceSettings& settings,
                               const Quantities& quantities, Pixel pixel) {
    const double depth = depth_at(layers, 0, pixel);
    if (depth == 0.0) return 0.0;
    return settings.spread_pixels > 0 ? settings.spread_pixels
                                      : layers.view.pixels_per_metre() * quantities.ao_radius / depth;
}

// What the estimator makes of taps, all of which count in the mean; `result` says whether they are ambiguous.
inline Visibility visibility_by_taps(const Layers& layers, const AmbientObscuranceSettings& settings,
                                     const Quantities& quantities, Pixel pixel, const std::vector<Tap>& taps,
                                     Visibility result = {}) {
    using Estimator = AmbientObscuranceEstimator;
    const Estimator estimator = settings.estimator;
    const bool thesis = estimator == Estimator::nielsen2015;
    const double depth = depth_at(layers, 0, pixel), radius = quantities.ao_radius;
    const double radius_pixels = radius_in_pixels(layers, settings, quantities, pixel);
    const glm::dvec3 centre = point_at(layers, 0, pixel);
    glm::dvec3 normal = vector_at(layers, layers.normal[0], pixel);
    if (settings.normals != ObscuranceNormals::interpolated) {
        const FaceNormal face =
            settings.normals == ObscuranceNormals::face ? face_normal(layers, pixel) : derivative_normal(layers, pixel);
        if (face.normal == glm::dvec3(0.0)) return {.ambiguous = face.ambiguous};
        normal = face.normal;
        result.ambiguous |= face.ambiguous;
    }
    // Of heights over the tangent plane that are as low as rounding may make them, as they are, and as high.
    glm::dvec3 sum(0.0);
    int hits = 0;
    for (const Tap& tap : taps) {
        if (!inside(layers, tap.pixel)) continue;
        glm::dvec3 largest(0.0), both(0.0);
        for (int layer = 0; layer < settings.layers; ++layer) {
            if (depth_at(layers, layer, tap.source) == 0.0) continue;
            const glm::dvec3 v = point_of_tap(layers, layer, tap, settings.mip_points) - centre;
            const double vv = glm::dot(v, v), vn = glm::dot(v, normal), relative_square = vv / (radius * radius);
            const double weight = falloff_of_square(quantities.ao_falloff, relative_square);
            // The hard falloff jumps at the radius.
            result.ambiguous |= quantities.ao_falloff == Falloff::hard && std::abs(relative_square - 1.0) < 1e-5;
            const double off = point_rounding * (depth + depth_at(layers, layer, tap.source));
            const glm::dvec3 heights(vn - off, vn, vn + off);
            const auto above = [&](double bias) { return glm::max(heights - bias, glm::dvec3(0.0)); };
            glm::dvec3 obscurance(0.0);
            switch (estimator) {
                case Estimator::mara2016:
                case Estimator::g3d_demo:
                case Estimator::linear:
                    obscurance = above(settings.bias) / std::sqrt(vv + settings.epsilon);
                    break;
                case Estimator::sao2012:
                    obscurance = above(settings.bias) / (vv + settings.epsilon);
                    break;
                case Estimator::sao2012_undivided:
                    obscurance = above(settings.bias) * (quantities.ao_falloff == Falloff::hard ? 2.0 : 4.0);
                    break;
                case Estimator::alchemy2011:
                    obscurance = above(settings.bias * depth) / (vv + settings.epsilon);
                    break;
                case Estimator::nielsen2015: {
                    if (vv == 0.0) break;
                    const double sine = vn / std::sqrt(vv);
                    if (weight > 0.0 && sine > least_hit_sine) {
                        obscurance =
                            above(settings.bias * depth * std::sqrt(vv)) / std::sqrt(vv) / (vv + settings.epsilon);
                        ++hits;
                    }
                    // A tap that is a hit or none according to rounding moves the mean of the others.
                    result.ambiguous |= std::abs(sine - least_hit_sine) < 1e-5 && weight > 0.0;
                    result.ambiguous |= std::abs(relative_square - 1.0) < 1e-5;
                    break;
                }
            }
            largest = glm::max(largest, weight * obscurance);
            both += weight * obscurance;
        }
        sum += thesis ? both : largest;
    }
    const glm::dvec3 mean = sum / (thesis ? std::max<double>(hits, 1) : static_cast<double>(taps.size()));
    const auto curve = [&](double of) {
        switch (estimator) {
            case Estimator::mara2016:
                return std::max(0.0, 1.0 - settings.intensity * std::sqrt(std::numbers::pi * of));
            case Estimator::g3d_demo: {
                const double facing = 0.65 + 0.35 * std::max(0.0, 1.5 * normal.z);
                const double visible = std::pow(std::max(0.0, 1.0 - std::sqrt(3.0 * of * facing)), settings.intensity);
                return 1.0 + std::clamp(radius_pixels - 3.0, 0.0, 1.0) * (visible - 1.0);
            }
            case Estimator::sao2012:
            case Estimator::sao2012_undivided: {
                const double plain = std::max(0.0, 1.0 - 5.0 * settings.intensity * of);
                return (std::pow(plain, 0.2) + 1.2 * std::pow(plain, 4.0)) / 2.2;
            }
            case Estimator::alchemy2011:
            case Estimator::nielsen2015:
                return std::pow(std::max(0.0, 1.0 - 2.0 * settings.intensity * of),
                                static_cast<double>(settings.exponent));
            case Estimator::linear:
                return std::max(0.0, 1.0 - 2.0 * settings.intensity * of);
        }
        return 0.0;
    };
    result.mean = mean.y;
    result.visibility = curve(mean.y);
    result.least = curve(mean.z), result.most = curve(mean.x);
    return result;
}

inline SpiralRequest taps_of(const AmbientObscuranceSettings& settings, double radius_pixels, Pixel pixel,
                             const SpiralPattern& pattern = {}) {
    return {.pixel = pixel,
            .radius_pixels = radius_pixels,
            .samples = settings.samples,
            .jitter = even_jitter(settings.pattern, settings.samples),
            .form = settings.pattern,
            .use_mip_chain = settings.use_mip_chain,
            .mip_offset = settings.mip_offset,
            .minimum_distance = settings.estimator == AmbientObscuranceEstimator::g3d_demo ? 0.75 : 0.0,
            .pattern = pattern};
}

inline Visibility ambient_visibility(const Layers& layers, const AmbientObscuranceSettings& settings,
                                     const Quantities& quantities, Pixel pixel, const SpiralPattern& pattern = {}) {
    const double radius_pixels = radius_in_pixels(layers, settings, quantities, pixel);
    if (radius_pixels < 1.0) return {};
    Visibility result;
    const std::vector<Tap> taps =
        spiral_taps(layers, taps_of(settings, radius_pixels, pixel, pattern), result.ambiguous);
    return visibility_by_taps(layers, settings, quantities, pixel, taps, result);
}

// The limit of many taps: the mean over the disc by a fine grid in radius and angle, over both of which taps are spread
// evenly.
inline Visibility limit_of_many_taps(const Layers& layers, const AmbientObscuranceSettings& settings,
                                     const Quantities& quantities, Pixel pixel) {
    constexpr int rings = 100, sectors = 200;
    const double radius_pixels = radius_in_pixels(layers, settings, quantities, pixel);
    const SpiralRequest request = taps_of(settings, radius_pixels, pixel);
    std::vector<Tap> taps;
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < sectors; ++j) {
            const double distance = std::max(request.minimum_distance, radius_pixels * (i + 0.5) / rings),
                         angle = 2.0 * std::numbers::pi * (j + 0.5) / sectors;
            const Pixel tap{pixel.x + static_cast<int>(std::floor(distance * std::cos(angle) + 0.5)),
                            pixel.y + static_cast<int>(std::floor(distance * std::sin(angle) + 0.5))};
            // Also of taps outside, whose source nobody looks at.
            taps.push_back({tap, inside(layers, tap) ? source_of_tap(layers, tap, distance, request) : tap});
        }
    }
    return visibility_by_taps(layers, settings, quantities, pixel, taps);
}

}  // namespace plumb::counterpart

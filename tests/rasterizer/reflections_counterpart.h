// Screen-space reflections on the CPU, from the formulas of rasterizer/reflections.h.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>

#include "frames/quantities.h"
#include "sample_spiral_counterpart.h"
#include "scenes/ggx.h"
#include "scenes/specular_albedo.h"

namespace plumb::counterpart {

// The specular side of the first layer.
struct Gloss {
    Image f0, f90, roughness;
};

struct ReflectionRequest {
    ReflectionSettings settings;  // thickness as it applies, in metres
    double radius = std::numeric_limits<double>::infinity();
    Falloff falloff = Falloff::hard;
    // What arrives from a world-space direction for a roughness where nothing is hit.
    std::function<glm::dvec3(const glm::dvec3&, double)> fallback = [](const glm::dvec3&, double) {
        return glm::dvec3(0.0);
    };
};

struct Reflected {
    glm::dvec3 radiance{0.0};
    int rays = 0, hits = 0, second_layer_hits = 0;
    bool ambiguous = false;
};

class ReflectionTracer {
public:
    ReflectionTracer(const Layers& layers, const Gloss& gloss, const ReflectionRequest& request)
        : layers_(layers), gloss_(gloss), request_(request) {
        if (request.settings.roughness == ReflectionRoughness::mip) make_chain();
    }

    Reflected reflect(Pixel pixel) const {
        Reflected result;
        const double depth = depth_at(layers_, 0, pixel);
        const glm::dvec3 f0 = vector_at(layers_, gloss_.f0, pixel);
        const double f90 = gloss_.f90.at(pixel.x, layers_.height() - 1 - pixel.y);
        if (depth == 0.0 || (f0 == glm::dvec3(0.0) && f90 == 0.0)) return result;
        const double roughness = gloss_.roughness.at(pixel.x, layers_.height() - 1 - pixel.y);
        const double alpha = ggx_alpha(static_cast<float>(roughness));
        const glm::dvec3 origin = point_at(layers_, 0, pixel), o = -glm::normalize(origin);
        const glm::dvec3 shading_normal = vector_at(layers_, layers_.normal[0], pixel);
        const double lean = glm::dot(shading_normal, o);
        result.ambiguous |= std::abs(lean) < 1e-4;  // whether the lobe's normal is turned
        const glm::dvec3 n = lean >= 0.0 ? shading_normal : glm::normalize(shading_normal - lean * o);
        const double cosine_o = std::max(0.0, glm::dot(n, o));
        if (request_.settings.roughness == ReflectionRoughness::samples && alpha > 0.0) {
            std::uint32_t x = hash(static_cast<std::uint32_t>(pixel.x) + 65536u * static_cast<std::uint32_t>(pixel.y));
            std::uint32_t y = hash(x + 0x9E3779B9u);
            glm::dvec3 across = o - cosine_o * n;
            if (!(glm::dot(across, across) > 1e-6))
                across = glm::cross(n, std::abs(n.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
            const glm::dvec3 tangent = glm::normalize(across), bitangent = glm::cross(n, tangent);
            for (int i = 0; i < request_.settings.samples; ++i) {
                const glm::dvec2 u((x >> 8) * 0x1p-24, (y >> 8) * 0x1p-24);
                x += 3242174889u, y += 2447445413u;  // 2^32 over the plastic number and its square
                const glm::dvec3 h = visible_normal(u, {glm::dot(o, tangent), 0.0, cosine_o}, alpha);
                const double cosine_oh = glm::dot(glm::dvec3(glm::dot(o, tangent), 0.0, cosine_o), h);
                const glm::dvec3 half = h.x * tangent + h.y * bitangent + h.z * n;
                const glm::dvec3 w = glm::normalize(2.0 * cosine_oh * half - o);
                const double cosine_i = glm::dot(w, n);
                result.ambiguous |= std::abs(cosine_i) < 1e-6;
                if (cosine_i <= 0.0) continue;
                // F G2 / G1 with G2 and G1 written out (Heitz 2014).
                const auto lambda = [alpha](double c) { return 0.5 * (smith_root(c, alpha) / c - 1.0); };
                const double passed =
                    cosine_o > 0.0 ? (1.0 + lambda(cosine_o)) / (1.0 + lambda(cosine_o) + lambda(cosine_i)) : 1.0;
                const glm::dvec3 fresnel = f0 + (glm::dvec3(f90) - f0) * std::pow(1.0 - cosine_oh, 5.0);
                result.radiance += fresnel * passed *
                                   arriving(pixel, origin, shading_normal, w, roughness, alpha, result) /
                                   static_cast<double>(request_.settings.samples);
            }
            return result;
        }
        const glm::dvec2 share(albedo_.split(static_cast<float>(cosine_o), static_cast<float>(alpha)));
        result.radiance = (share.x * f0 + share.y * f90) *
                          arriving(pixel, origin, shading_normal, 2.0 * cosine_o * n - o, roughness, alpha, result);
        return result;
    }

    // The lobe's integral over the hemisphere by a midpoint rule of order^2 directions, even in solid angle.
    glm::dvec3 integrate(Pixel pixel, int order) const {
        const double roughness = gloss_.roughness.at(pixel.x, layers_.height() - 1 - pixel.y);
        const double alpha = ggx_alpha(static_cast<float>(roughness));
        const glm::dvec3 f0 = vector_at(layers_, gloss_.f0, pixel);
        const double f90 = gloss_.f90.at(pixel.x, layers_.height() - 1 - pixel.y);
        const glm::dvec3 origin = point_at(layers_, 0, pixel), o = -glm::normalize(origin);
        const glm::dvec3 n = vector_at(layers_, layers_.normal[0], pixel);
        const glm::dvec3 tangent = glm::normalize(glm::cross(n, glm::dvec3(0.3, -0.5, 0.7)));
        const glm::dvec3 bitangent = glm::cross(n, tangent);
        const double cosine_o = glm::dot(n, o);
        Reflected ignored;
        glm::dvec3 sum(0.0);
        for (int i = 0; i < order; ++i) {
            for (int j = 0; j < order; ++j) {
                const double cosine_i = (i + 0.5) / order, azimuth = 2.0 * std::numbers::pi * (j + 0.5) / order;
                const double sine = std::sqrt(1.0 - cosine_i * cosine_i);
                const glm::dvec3 w =
                    sine * (std::cos(azimuth) * tangent + std::sin(azimuth) * bitangent) + cosine_i * n;
                const glm::dvec3 h = glm::normalize(o + w);
                const double cosine_h = glm::dot(n, h);
                const double visibility =
                    smith_visibility(cosine_o, smith_root(cosine_o, alpha), cosine_i, smith_root(cosine_i, alpha));
                const glm::dvec3 f = (f0 + (glm::dvec3(f90) - f0) * std::pow(1.0 - glm::dot(o, h), 5.0)) *
                                     ggx_distribution(cosine_h, 1.0 - cosine_h * cosine_h, alpha) * visibility;
                sum += f * cosine_i * arriving(pixel, origin, n, w, roughness, alpha, ignored);
            }
        }
        return sum * (2.0 * std::numbers::pi / (order * order));
    }

private:
    struct Hit {
        int layer;
        Pixel pixel;
        glm::dvec2 position;
        double distance, height;
    };

    static std::uint32_t hash(std::uint32_t x) {
        x = (x ^ (x >> 16)) * 0x7FEB352Du;
        x = (x ^ (x >> 15)) * 0x846CA68Bu;
        return x ^ (x >> 16);
    }

    // As Heitz 2018: half way between the stretched viewer and a point of the cap of directions above -view.z.
    static glm::dvec3 visible_normal(glm::dvec2 u, const glm::dvec3& o, double alpha) {
        const glm::dvec3 view = glm::normalize(glm::dvec3(alpha * o.x, alpha * o.y, o.z));
        const double z = (1.0 - u.x) * (1.0 + view.z) - view.z;
        const double sine = std::sqrt(std::max(0.0, 1.0 - z * z)), azimuth = 2.0 * std::numbers::pi * u.y;
        const glm::dvec3 half = glm::dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), z) + view;
        return glm::normalize(glm::dvec3(alpha * half.x, alpha * half.y, half.z));
    }

    glm::dvec2 project(const glm::dvec3& point) const {
        const glm::dvec2 tan_half(layers_.view.tan_half());
        const glm::dvec2 ndc = glm::dvec2(point) / (-point.z * tan_half);
        return 0.5 * (ndc + 1.0) * glm::dvec2(layers_.width(), layers_.height());
    }

    // The ray's end: by bisection between what lies in the view and what does not.
    double length_in_view(const glm::dvec3& origin, const glm::dvec3& w) const {
        const Camera& camera = layers_.view.camera();
        const glm::dvec2 tan_half(layers_.view.tan_half());
        const auto inside = [&](double t) {
            const glm::dvec3 p = origin + t * w;
            return -p.z >= camera.near_plane && -p.z <= camera.far_plane && std::abs(p.x) <= -p.z * tan_half.x &&
                   std::abs(p.y) <= -p.z * tan_half.y;
        };
        double low = 0.0, high = std::min({static_cast<double>(request_.settings.max_distance), request_.radius,
                                           4.0 * camera.far_plane * (1.0 + glm::length(tan_half))});
        if (inside(high)) return high;
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (low + high);
            (inside(middle) ? low : high) = middle;
        }
        return low;
    }

    std::optional<Hit> trace(Pixel pixel, const glm::dvec3& origin, const glm::dvec3& n, const glm::dvec3& w,
                             Reflected& result) const {
        const ReflectionSettings& settings = request_.settings;
        const glm::dvec3 end = origin + length_in_view(origin, w) * w;
        const glm::dvec2 start(pixel.x + 0.5, pixel.y + 0.5), across = project(end) - start;
        const double length = std::max(std::abs(across.x), std::abs(across.y));
        const auto position = [&](double a) { return start + a / length * across; };
        const auto depth = [&](double a) { return 1.0 / glm::mix(-1.0 / origin.z, -1.0 / end.z, a / length); };
        const auto pixel_at = [&](double a) {
            const glm::dvec2 p = position(a);
            for (int axis = 0; axis < 2; ++axis) {
                // The longer axis is walked along exactly; the other one's slope has the rounding of the end point.
                const double off = std::abs(p[axis] - std::round(p[axis]));
                const bool exact = std::abs(across[axis]) == length && off < 1e-9;
                result.ambiguous |= !exact && off < 1e-4 * (1.0 + 0.01 * a);
            }
            return Pixel{std::clamp(static_cast<int>(std::floor(p.x + 1e-9)), 0, layers_.width() - 1),
                         std::clamp(static_cast<int>(std::floor(p.y + 1e-9)), 0, layers_.height() - 1)};
        };
        const auto meets = [&](double a, double b, Pixel p, int layer) {
            const double surface = depth_at(layers_, layer, p);
            if (surface == 0.0) return false;
            const double low = std::min(a, b), high = std::max(a, b);
            const double doubt = 2e-5 * surface;
            const double front = settings.hit == ReflectionHit::mara2016 ? surface - settings.thickness : surface;
            result.ambiguous |= std::abs(high - front) < doubt && low <= surface + settings.thickness + doubt;
            result.ambiguous |= std::abs(low - surface - settings.thickness) < doubt && high >= front - doubt;
            return high >= front && low <= surface + settings.thickness;
        };
        // Or, with hit = crossed, got from one side of the layer to the other.
        const auto meets_between = [&](double from, double to, int layer) {
            bool met = meets(depth(from), depth(to), pixel_at(to), layer);
            const Pixel first = pixel_at(from);
            if (settings.hit != ReflectionHit::crossed || (layer == 0 && first == pixel)) return met;
            const double surface_before = depth_at(layers_, layer, first),
                         surface = depth_at(layers_, layer, pixel_at(to));
            if (surface_before == 0.0 || surface == 0.0) return met;
            const double in_front = surface_before - depth(from), behind = depth(to) - surface;
            const bool open_before = std::abs(in_front) < 2e-5 * surface_before,
                       open_now = std::abs(behind) < 2e-5 * surface;
            result.ambiguous |= !met && ((open_before && (behind >= 0.0 || open_now)) || (open_now && in_front >= 0.0));
            met = met || (in_front >= 0.0 && behind >= 0.0);
            return met;
        };
        double before = 0.0;
        for (int i = 0; i < settings.max_steps; ++i) {
            const double along = settings.first_step + static_cast<double>(i) * settings.step;
            result.ambiguous |= std::abs(along - length) < 1e-3;
            if (along > length) break;
            for (int layer = 0; layer < settings.layers; ++layer) {
                if (!meets_between(before, along, layer)) continue;
                double low = before, high = along;
                for (int k = 0; k < settings.refinement_steps; ++k) {
                    const double middle = 0.5 * (low + high);
                    const Pixel at = pixel_at(middle);
                    const bool own = layer == 0 && at == pixel;
                    if (!own && meets_between(low, middle, layer)) {
                        high = middle;
                    } else {
                        low = middle;
                    }
                }
                const Pixel found = pixel_at(high);
                if (depth_at(layers_, layer, found) == 0.0) continue;
                const glm::dvec3 offset = point_at(layers_, layer, found) - origin;
                const double above = glm::dot(offset, n);
                const double turned = glm::dot(w, vector_at(layers_, layers_.normal[layer], found));
                const bool above_is_open = std::abs(above - settings.bias) < 1e-5 * (1.0 + glm::length(offset));
                const bool turned_is_open = settings.test_hit_normal && std::abs(turned) < 1e-5;
                result.ambiguous |= above_is_open || turned_is_open;
                if (above <= settings.bias || (settings.test_hit_normal && turned >= 0.0)) continue;
                return Hit{layer, found, position(high), glm::length(offset), above};
            }
            before = along;
        }
        return std::nullopt;
    }

    glm::dvec3 arriving(Pixel pixel, const glm::dvec3& origin, const glm::dvec3& n, const glm::dvec3& w,
                        double roughness, double alpha, Reflected& result) const {
        const std::optional<Hit> hit = trace(pixel, origin, n, w, result);
        const double cosine_o = std::max(0.0, glm::dot(n, -glm::normalize(origin)));
        ++result.rays;
        glm::dvec3 radiance(0.0);
        double weight = 0.0;
        if (hit) {
            ++result.hits;
            result.second_layer_hits += hit->layer;
            const glm::dvec2 far_side = glm::dvec2(layers_.width(), layers_.height()) - hit->position;
            const double to_border = std::min({hit->position.x, hit->position.y, far_side.x, far_side.y});
            weight = request_.settings.border_fade > 0 ? std::clamp(to_border / request_.settings.border_fade, 0.0, 1.0)
                                                       : 1.0;
            radiance = weight * falloff_of_square(request_.falloff, std::pow(hit->distance / request_.radius, 2.0)) *
                       radiance_of(*hit, alpha, cosine_o);
        }
        const bool samples = request_.settings.roughness == ReflectionRoughness::samples;
        const glm::dmat3 world_from_camera(layers_.view.camera().world_from_camera);
        return radiance + (1.0 - weight) * request_.fallback(world_from_camera * w, samples ? 0.0 : roughness);
    }

    glm::dvec3 radiance_of(const Hit& hit, double alpha, double cosine_o) const {
        const glm::dvec3 at_hit = vector_at(layers_, layers_.radiance[hit.layer], hit.pixel);
        if (request_.settings.roughness != ReflectionRoughness::mip) return at_hit;
        const double tangent = 2.0 * alpha / std::max(1.0 - alpha * alpha, 1e-3) * std::sqrt(cosine_o);
        const double width = std::min(std::sqrt(2.0 * std::numbers::pi) * tangent * hit.distance, 2.0 * hit.height);
        const double side =
            std::max(width * layers_.view.pixels_per_metre() / depth_at(layers_, hit.layer, hit.pixel), 1.0);
        const double level = std::min(std::log2(side), static_cast<double>(chain_[hit.layer].size() - 1));
        const int finer = static_cast<int>(level);
        glm::dvec4 mean = bilinear(chain_[hit.layer][finer], hit.position / std::exp2(finer));
        if (level > finer) {
            mean = glm::mix(mean, bilinear(chain_[hit.layer][finer + 1], hit.position / std::exp2(finer + 1)),
                            level - finer);
        }
        return mean.w > 0.0 ? glm::dvec3(mean) / mean.w : at_hit;
    }

    // A level of the radiance MIP chain: rgb and coverage, bottom row first.
    struct Level {
        int width, height;
        std::vector<glm::dvec4> texels;
        const glm::dvec4& at(int x, int y) const {
            return texels[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * width +
                          static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
        }
    };

    static glm::dvec4 bilinear(const Level& level, glm::dvec2 at) {
        const glm::dvec2 corner = glm::floor(at - 0.5), part = at - 0.5 - corner;
        const int x = static_cast<int>(corner.x), y = static_cast<int>(corner.y);
        return glm::mix(glm::mix(level.at(x, y), level.at(x + 1, y), part.x),
                        glm::mix(level.at(x, y + 1), level.at(x + 1, y + 1), part.x), part.y);
    }

    void make_chain() {
        for (int layer = 0; layer < request_.settings.layers; ++layer) {
            std::vector<Level> levels{{layers_.width(), layers_.height(), {}}};
            for (int y = 0; y < layers_.height(); ++y) {
                for (int x = 0; x < layers_.width(); ++x) {
                    const bool there = depth_at(layers_, layer, {x, y}) != 0.0;
                    levels[0].texels.push_back(
                        there ? glm::dvec4(vector_at(layers_, layers_.radiance[layer], {x, y}), 1.0) : glm::dvec4(0.0));
                }
            }
            while (std::min(levels.back().width, levels.back().height) > 1) {
                const Level& fine = levels.back();
                Level coarse{fine.width / 2, fine.height / 2, {}};
                for (int y = 0; y < coarse.height; ++y) {
                    for (int x = 0; x < coarse.width; ++x) {
                        coarse.texels.push_back(0.25 * (fine.at(2 * x, 2 * y) + fine.at(2 * x + 1, 2 * y) +
                                                        fine.at(2 * x, 2 * y + 1) + fine.at(2 * x + 1, 2 * y + 1)));
                    }
                }
                levels.push_back(std::move(coarse));
            }
            chain_.push_back(std::move(levels));
        }
    }

    const Layers& layers_;
    const Gloss& gloss_;
    const ReflectionRequest request_;
    const SpecularAlbedo albedo_;
    std::vector<std::vector<Level>> chain_;  // by layer
};

}  // namespace plumb::counterpart

// The screen-space passes once more: on the CPU, in double precision, straight from the formulas, for the tests.
//
// A tap falls into one pixel or its neighbour: where a double and a float calculation may disagree on that (or on any
// other yes-or-no question), the counterpart says so, and the test leaves the pixel out.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include <glm/glm.hpp>

#include "frames/image.h"
#include "frames/quantities.h"
#include "rasterizer/method.h"
#include "rasterizer/sample_spiral.h"
#include "scenes/camera.h"

namespace plumb::counterpart {

// One or two layers of a view; images are stored top row first, depth is 0 where there is nothing.
struct Layers {
    View view;
    std::vector<Image> depth, normal, radiance;
    std::vector<Image> position =
        {};  // camera space; where there is none, points are those of depth at pixels' centres
    int width() const { return view.width(); }
    int height() const { return view.height(); }
};

// Pixels as the passes count them: from the bottom left.
struct Pixel {
    int x, y;
    bool operator==(const Pixel&) const = default;
};

inline bool inside(const Layers& layers, Pixel p) {
    return p.x >= 0 && p.y >= 0 && p.x < layers.width() && p.y < layers.height();
}
inline double depth_at(const Layers& layers, int layer, Pixel p) {
    return layers.depth[layer].at(p.x, layers.height() - 1 - p.y);
}
inline glm::dvec3 vector_at(const Layers& layers, const Image& image, Pixel p) {
    const auto values = image.pixel(p.x, layers.height() - 1 - p.y);
    return {values[0], values[1], values[2]};
}
// One metre along -Z through the pixel's centre.
inline glm::dvec3 ray_at(const Layers& layers, Pixel p) {
    const glm::dvec2 tan_half(layers.view.tan_half());
    const double u = 2.0 * (p.x + 0.5) / layers.width() - 1.0;
    const double v = 2.0 * (p.y + 0.5) / layers.height() - 1.0;
    return {u * tan_half.x, v * tan_half.y, -1.0};
}
inline glm::dvec3 point_at(const Layers& layers, int layer, Pixel p) {
    if (!layers.position.empty()) return vector_at(layers, layers.position[layer], p);
    return depth_at(layers, layer, p) * ray_at(layers, p);
}

// Rotated-grid subsampling, step by step: the pixel of level 0 that a texel of `level` shows.
inline Pixel pixel_of_texel(Pixel texel, int level) {
    for (; level > 0; --level) texel = {2 * texel.x + (texel.y & 1), 2 * texel.y + (texel.x & 1)};
    return texel;
}

struct Tap {
    Pixel pixel;   // where the spiral points
    Pixel source;  // the pixel of level 0 that is read
};

// A tap's point in a layer.
inline glm::dvec3 point_of_tap(const Layers& layers, int layer, const Tap& tap, MipTapPoint points) {
    return points == MipTapPoint::exact ? point_at(layers, layer, tap.source)
                                        : depth_at(layers, layer, tap.source) * ray_at(layers, tap.pixel);
}

// Which pattern of taps: moved by a seed, and turned from frame to frame where taps vary in time.
struct SpiralPattern {
    glm::ivec2 shift{0};
    std::uint32_t frame = 0;  // since the last cut; 0 where taps do not vary
};

struct SpiralRequest {
    Pixel pixel;
    double radius_pixels;
    int samples;
    std::uint32_t jitter;  // in 2^-16
    TapPattern form = TapPattern::sao2012;
    bool use_mip_chain;
    int mip_offset;
    int minimum_mip_level = 0;
    double minimum_distance = 0.0;
    SpiralPattern pattern = {};
};

// 32 bits that look random.
inline std::uint32_t hash_of(Pixel pixel, const SpiralPattern& pattern = {}) {
    std::uint32_t h = static_cast<std::uint32_t>(pixel.x + pattern.shift.x) * 0x9E3779B1u ^
                      static_cast<std::uint32_t>(pixel.y + pattern.shift.y) * 0x85EBCA77u;
    h = (h ^ (h >> 15)) * 0xC2B2AE3Du;
    return (h ^ (h >> 13)) * 0x27D4EB2Fu;
}

// In 2^-16, of a pattern whose jitter is the same in all pixels: one half, or half of a turn's share.
inline std::uint32_t even_jitter(TapPattern form, int samples) {
    const int turns = form == TapPattern::nielsen2015 ? spiral_turns(samples) : 1;
    return static_cast<std::uint32_t>(std::floor(0.5 / turns * 65536.0));
}

// The pixel of level 0 that a tap `distance` pixels away reads.
inline Pixel source_of_tap(const Layers& layers, Pixel tap, double distance, const SpiralRequest& request) {
    const int smaller_side = std::min(layers.width(), layers.height());
    const int coarsest =
        request.use_mip_chain ? std::min(5, static_cast<int>(std::bit_width(unsigned(smaller_side))) - 1) : 0;
    const int level_wanted = distance < 1.0 ? 0 : static_cast<int>(std::floor(std::log2(distance)));
    const int level =
        std::clamp(level_wanted - request.mip_offset, std::min(request.minimum_mip_level, coarsest), coarsest);
    const Pixel texel{std::min(tap.x >> level, (layers.width() >> level) - 1),
                      std::min(tap.y >> level, (layers.height() >> level) - 1)};
    return pixel_of_texel(texel, level);
}

// The taps of a pixel; `ambiguous` becomes true where rounding may move one of them.
inline std::vector<Tap> spiral_taps(const Layers& layers, const SpiralRequest& request, bool& ambiguous) {
    const std::uint32_t x = static_cast<std::uint32_t>(request.pixel.x + request.pattern.shift.x),
                        y = static_cast<std::uint32_t>(request.pixel.y + request.pattern.shift.y);
    const std::uint32_t hash = (3 * x) ^ (y + x * y);
    // 10 radians a step, and the jitter's share of tau turns, both in units of 2^-32 turns that wrap around.
    const auto spin_unit = static_cast<std::uint32_t>(std::fmod(10.0 / (2.0 * std::numbers::pi), 1.0) * 0x1p32);
    const auto jitter_unit = static_cast<std::uint32_t>(65536.0 * spiral_turns(request.samples) / request.samples);
    // The fraction of the golden ratio, (sqrt 5 - 1) / 2, of a turn for each frame.
    const auto frame_unit = static_cast<std::uint32_t>((std::sqrt(5.0) - 1.0) / 2.0 * 0x1p32);
    const std::uint32_t spun =
        request.form == TapPattern::sao2012 ? hash * spin_unit : hash_of(request.pixel, request.pattern);
    const std::uint32_t turned = spun + request.jitter * jitter_unit + request.pattern.frame * frame_unit;
    const double spin = static_cast<double>(turned >> 22) / 1024.0;

    std::vector<Tap> taps;
    for (int i = 0; i < request.samples; ++i) {
        const double alpha = (i + request.jitter / 65536.0) / request.samples;
        const double distance = std::max(request.minimum_distance, alpha * request.radius_pixels);
        const double turns = static_cast<double>(i) / request.samples * spiral_turns(request.samples) + spin;
        const double angle = 2.0 * std::numbers::pi * turns;
        const double dx = distance * std::cos(angle) + 0.5, dy = distance * std::sin(angle) + 0.5;
        // Float rounding of the distance and of the rotated direction moves a tap by a few 1e-7 of the distance.
        const double doubt = 1e-6 * std::max(1.0, distance);
        for (const double d : {dx, dy}) ambiguous |= std::abs(d - std::round(d)) < doubt;
        ambiguous |= std::abs(distance - std::round(distance)) < doubt && distance > 0.5;

        const Pixel tap{request.pixel.x + static_cast<int>(std::floor(dx)),
                        request.pixel.y + static_cast<int>(std::floor(dy))};
        taps.push_back({tap, source_of_tap(layers, tap, distance, request)});
    }
    return taps;
}

// Two layers of noise: every pixel has a depth and a normal of its own, some have nothing in one layer or in both.
// Nothing is smooth, so that a tap one pixel off is sure to show.
inline Layers random_layers(const View& view, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    Layers layers{view, {}, {}, {}};
    for (int layer = 0; layer < 2; ++layer) {
        Image depth(view.width(), view.height(), 1), normal(view.width(), view.height(), 3),
            radiance(view.width(), view.height(), 3);
        for (int y = 0; y < view.height(); ++y) {
            for (int x = 0; x < view.width(); ++x) {
                const bool missing =
                    uniform(generator) < (layer == 0 ? 0.1f : 0.4f) || (layer == 1 && layers.depth[0].at(x, y) == 0.0f);
                const float nearest = layer == 0 ? 2.0f : layers.depth[0].at(x, y) + 0.1f;
                depth.at(x, y) = missing ? 0.0f : nearest + uniform(generator);
                const glm::vec3 direction =
                    glm::normalize(glm::vec3(2.0f * uniform(generator) - 1.0f, 2.0f * uniform(generator) - 1.0f, 1.0f));
                for (int c = 0; c < 3; ++c) {
                    normal.at(x, y, c) = missing ? 0.0f : direction[c];
                    radiance.at(x, y, c) = missing ? 0.0f : uniform(generator);
                }
            }
        }
        layers.depth.push_back(depth);
        layers.normal.push_back(normal);
        layers.radiance.push_back(radiance);
    }
    return layers;
}

inline double falloff_of_square(Falloff falloff, double relative_square) {
    if (relative_square >= 1.0) return 0.0;
    const double quadratic = 1.0 - relative_square;
    return falloff == Falloff::hard ? 1.0 : falloff == Falloff::quadratic ? quadratic : std::pow(quadratic, 3.0);
}

}  // namespace plumb::counterpart

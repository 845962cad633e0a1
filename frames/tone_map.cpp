#include "frames/tone_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "frames/image_error.h"

namespace plumb {
namespace {

constexpr std::array<std::string_view, 3> names{"linear", "filmic", "aces"};
constexpr int bloom_levels = 6;

float hable(float x) {
    constexpr float a = 0.15f, b = 0.50f, c = 0.10f, d = 0.20f, e = 0.02f, f = 0.30f;
    return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
}

// At half the size; an odd last row or column counts by itself.
Image halved(const Image& image) {
    Image half((image.width() + 1) / 2, (image.height() + 1) / 2, image.channels());
    for (int y = 0; y < half.height(); ++y) {
        const int next_y = std::min(2 * y + 1, image.height() - 1);
        for (int x = 0; x < half.width(); ++x) {
            const int next_x = std::min(2 * x + 1, image.width() - 1);
            for (int c = 0; c < image.channels(); ++c) {
                half.at(x, y, c) = 0.25f * (image.at(2 * x, 2 * y, c) + image.at(next_x, 2 * y, c) +
                                            image.at(2 * x, next_y, c) + image.at(next_x, next_y, c));
            }
        }
    }
    return half;
}

// Adds `share` of a level whose texels are `size` pixels wide.
void add_level(Image& sum, const Image& level, int size, float share) {
    const auto corner = [size](int i, int last, float& part) {
        const float at = std::clamp((static_cast<float>(i) + 0.5f) / static_cast<float>(size) - 0.5f, 0.0f,
                                    static_cast<float>(last));
        part = at - std::floor(at);
        return static_cast<int>(at);
    };
    for (int y = 0; y < sum.height(); ++y) {
        float v = 0.0f;
        const int low_y = corner(y, level.height() - 1, v), high_y = std::min(low_y + 1, level.height() - 1);
        for (int x = 0; x < sum.width(); ++x) {
            float u = 0.0f;
            const int low_x = corner(x, level.width() - 1, u), high_x = std::min(low_x + 1, level.width() - 1);
            for (int c = 0; c < sum.channels(); ++c) {
                const float low = std::lerp(level.at(low_x, low_y, c), level.at(high_x, low_y, c), u);
                const float high = std::lerp(level.at(low_x, high_y, c), level.at(high_x, high_y, c), u);
                sum.at(x, y, c) += share * std::lerp(low, high, v);
            }
        }
    }
}

}  // namespace

std::string_view to_string(ToneCurve curve) { return names.at(static_cast<std::size_t>(curve)); }

ToneCurve tone_curve_from_string(std::string_view name) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) {
        throw ImageError(fmt::format("unknown tone curve '{}'; use linear, filmic or aces", name));
    }
    return static_cast<ToneCurve>(found - names.begin());
}

float apply_tone_curve(ToneCurve curve, float exposed) {
    constexpr float farthest = 1e6f;  // where both curves have long reached their end, and floats have not
    const float x = std::min(exposed, farthest);
    switch (curve) {
        case ToneCurve::linear:
            return exposed;
        case ToneCurve::filmic: {
            static const float white = hable(11.2f);
            return std::min(hable(2.0f * x) / white, 1.0f);
        }
        case ToneCurve::aces:
            return std::min(x * (AcesFit::a * x + AcesFit::b) / (x * (AcesFit::c * x + AcesFit::d) + AcesFit::e), 1.0f);
    }
    return exposed;
}

Image with_bloom(const Image& radiance, float strength) {
    if (!(strength >= 0.0f && strength <= 1.0f)) {
        throw ImageError(fmt::format("a bloom of strength {} is none; use 0 (off) to 1", strength));
    }
    if (strength == 0.0f) return radiance;
    Image finite = radiance;
    for (float& value : finite.values()) value = std::isfinite(value) ? value : 0.0f;
    Image result = finite;
    for (float& value : result.values()) value *= 1.0f - strength;
    for (int level = 1; level <= bloom_levels; ++level) {
        finite = halved(finite);
        add_level(result, finite, 1 << level, strength / bloom_levels);
    }
    for (std::size_t i = 0; i < result.values().size(); ++i) {
        if (!std::isfinite(radiance.values()[i])) result.values()[i] = radiance.values()[i];
    }
    return result;
}

}  // namespace plumb

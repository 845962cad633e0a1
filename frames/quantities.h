// What is asked for: the parameters of the quantities that method and truth are compared on. Both renderers are always
// given the same ones, so that a radius or a falloff can never differ between them.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// How what lies at distance d counts within radius r: occluders towards ambient visibility, senders towards indirect
// light. Zero from r on.
enum class Falloff {
    hard,       // 1
    quadratic,  // 1 - d^2/r^2
    cubic,      // (1 - d^2/r^2)^3
};

inline float evaluate_falloff(Falloff falloff, float distance, float radius) {
    if (distance >= radius) return 0.0f;
    const float ratio = distance / radius;  // 0 for an infinite radius
    const float quadratic = 1.0f - ratio * ratio;
    switch (falloff) {
        case Falloff::hard:
            return 1.0f;
        case Falloff::quadratic:
            return quadratic;
        case Falloff::cubic:
            return quadratic * quadratic * quadratic;
    }
    return 0.0f;
}
std::string_view to_string(Falloff falloff);
Falloff falloff_from_string(std::string_view name);  // throws ImageError that lists the names

// After so many bounces a furnace whose walls reflect 0.99 has lost all but 1e-9 of its light.
constexpr int most_diffuse_bounces = 2048;

struct Quantities {
    // Planes wanted, by name: "ao", "direct", "indirect", "indirect.1".., "irradiance", "emission", "total", and the
    // G-buffer's "depth", "normal", "albedo", "motion", "layer2.depth"... A renderer computes these and nothing else.
    std::vector<std::string> planes;

    float ao_radius = 1.0f;  // metres; infinity: the whole hemisphere
    Falloff ao_falloff = Falloff::quadratic;

    int bounces = 1;  // diffuse bounces K that indirect, irradiance and total contain
    // Metres: light that arrives at a shaded point from farther away than this does not count as indirect; `direct`
    // knows no radius. Infinity: all (what a user wants); the method's radius: what the method tried.
    float indirect_radius = std::numeric_limits<float>::infinity();
    Falloff indirect_falloff = Falloff::hard;  // how light counts that arrives from a distance within that radius
    // The same for what a shaded point shows through its specular lobe: `reflection`.
    float reflection_radius = std::numeric_limits<float>::infinity();
    Falloff reflection_falloff = Falloff::hard;

    bool wants(std::string_view plane) const;
    // True where any wanted plane is `prefix` itself or begins with `prefix` and a dot.
    bool wants_any(std::string_view prefix) const;
};

}  // namespace plumb

// Holds ambient visibility against the counterpart, pixel by pixel.
#pragma once

#include <gtest/gtest.h>

#include "ambient_obscurance_counterpart.h"
#include "screen_space_run.h"

namespace plumb {

inline Method unblurred(AmbientObscuranceSettings ao) {
    ao.blur.radius = 0;
    Method method;
    method.ao = ao;
    return method;
}

inline Quantities ambient_visibility_within(float radius, Falloff falloff = Falloff::quadratic) {
    return {.planes = {"ao"}, .ao_radius = radius, .ao_falloff = falloff};
}

inline bool is_right(double visibility, const counterpart::Visibility& expected) {
    // What is left besides the rounding of points: that of sums and curves.
    constexpr double tolerance = 4e-6;
    return visibility > expected.least - tolerance && visibility < expected.most + tolerance;
}

// Compares image and counterpart pixel by pixel; returns the share of pixels that rounding leaves open.
inline double expect_agreement(const counterpart::Layers& layers, const AmbientObscuranceSettings& settings,
                               const Quantities& quantities, const Image& ao,
                               const counterpart::SpiralPattern& pattern = {}) {
    const int width = layers.width(), height = layers.height();
    int ambiguous = 0, wrong = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const counterpart::Visibility expected =
                counterpart::ambient_visibility(layers, settings, quantities, {x, y}, pattern);
            ambiguous += expected.ambiguous;
            if (expected.ambiguous) continue;
            const double actual = ao.at(x, height - 1 - y);
            if (!is_right(actual, expected) && ++wrong < 5) {
                ADD_FAILURE() << "pixel (" << x << ", " << y << ") from the bottom left: " << actual << ", expected "
                              << expected.visibility << ", at least " << expected.least << ", at most " << expected.most
                              << " (mean obscurance " << expected.mean << ")";
            }
        }
    }
    EXPECT_EQ(wrong, 0);
    return static_cast<double>(ambiguous) / (width * height);
}

inline double expect_agreement(GlContext& context, const counterpart::Layers& given,
                               const AmbientObscuranceSettings& settings, const Quantities& quantities) {
    ScreenSpaceRun run(context, given, unblurred(settings), quantities);
    const Image ao = run.render("ao", 1);
    return expect_agreement(run.layers(), settings, quantities, ao);
}

struct ObscuranceCase {
    const char* name;
    AmbientObscuranceSettings settings;
    Falloff falloff = Falloff::quadratic;
};

// A floor, a wall, and a table in front of them under which the second layer sees.
inline std::vector<Patch> obscuring_room() {
    return {{{-4.0f, -1.0f, -7.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 8.0f}},
            {{-4.0f, -1.0f, -6.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 6.0f, 0.0f}},
            {{-0.8f, -0.5f, -5.5f}, {1.6f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f}}};
}

}  // namespace plumb

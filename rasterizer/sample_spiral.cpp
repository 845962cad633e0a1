#include "rasterizer/sample_spiral.h"

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

// tau(N) for N = 0..99; beyond the table the source takes one prime far above N.
constexpr std::array<int, 100> turns_table = {1,  1,  1,  2,  3,  2,  5,  2,  3,  2,   //
                                              3,  3,  5,  5,  3,  4,  7,  5,  5,  7,   //
                                              9,  8,  5,  5,  7,  7,  7,  8,  5,  8,   //
                                              11, 12, 7,  10, 13, 8,  11, 8,  7,  14,  //
                                              11, 11, 13, 12, 13, 19, 17, 13, 11, 18,  //
                                              19, 11, 11, 14, 17, 21, 15, 16, 17, 18,  //
                                              13, 17, 11, 17, 19, 18, 25, 18, 19, 19,  //
                                              29, 21, 19, 27, 31, 29, 21, 18, 17, 29,  //
                                              31, 31, 23, 18, 25, 26, 25, 23, 19, 34,  //
                                              19, 27, 21, 25, 39, 29, 17, 21, 27, 29};
constexpr int turns_beyond_table = 5779;

glm::vec2 direction(double turns) {
    const double angle = 2.0 * std::numbers::pi * turns;
    return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

// Two unit vectors to a vec4, because std140 pads anything smaller.
template <std::size_t size>
void store(std::array<glm::vec4, size>& table, int index, const glm::vec2& value) {
    glm::vec4& pair = table[static_cast<std::size_t>(index / 2)];
    pair[index % 2 * 2] = value.x;
    pair[index % 2 * 2 + 1] = value.y;
}

}  // namespace

int spiral_turns(int samples) {
    if (samples < 1 || samples > maximum_spiral_samples) {
        throw MethodError(
            fmt::format("{} samples per pixel are out of range; use 1 to {}", samples, maximum_spiral_samples));
    }
    return samples < static_cast<int>(turns_table.size()) ? turns_table[static_cast<std::size_t>(samples)]
                                                          : turns_beyond_table;
}

glm::ivec2 pattern_shift(std::uint32_t seed) {
    if (seed == 0) return {0, 0};
    std::uint64_t hash = seed * std::uint64_t{0x9E3779B97F4A7C15};
    hash = (hash ^ hash >> 32) * std::uint64_t{0xD6E8FEB86659FD93};
    return {static_cast<int>(hash >> 49), static_cast<int>(hash >> 32 & 0x7fff)};
}

SpiralTables::SpiralTables(int samples) {
    const int turns = spiral_turns(samples);
    for (int i = 0; i < samples; ++i) {
        // Whole turns are dropped in integers: what is left is exact.
        store(tap_directions, i, direction(static_cast<double>(i * turns % samples) / samples));
    }
    for (int i = 0; i < spiral_spin_count; ++i) {
        store(spin_directions, i, direction(static_cast<double>(i) / spiral_spin_count));
    }
}

SampleSpiral::SampleSpiral(GlContext& context, int samples) {
    const SpiralTables tables(samples);
    tables_ = GlBuffer(context, sizeof(tables), &tables);
}

ShaderDefines SampleSpiral::defines(int samples, TapPattern pattern, bool varies_in_time) {
    constexpr double turns_per_hash = 10.0 / (2.0 * std::numbers::pi);
    const auto wrapped = static_cast<std::uint32_t>((turns_per_hash - std::floor(turns_per_hash)) * 0x1p32);
    // The fraction of the golden ratio in 2^-32 turns.
    const std::uint32_t turns_per_frame = varies_in_time ? 0x9E3779B9u : 0u;
    const bool nielsen = pattern == TapPattern::nielsen2015;
    const int half = 0x8000;  // in 2^-16
    const auto turns_per_jitter = static_cast<std::uint32_t>(0x1p16 * spiral_turns(samples) / samples);
    return {{"SPIRAL_BINDING", std::to_string(binding)},
            {"SPIRAL_MAXIMUM_SAMPLES", std::to_string(maximum_spiral_samples)},
            {"SPIRAL_SPIN_COUNT", std::to_string(spiral_spin_count)},
            {"SPIRAL_SPIN_BITS", std::to_string(spiral_spin_bits)},
            {"SPIRAL_SAMPLES", std::to_string(samples)},
            {"SPIRAL_NIELSEN2015", nielsen ? "1" : "0"},
            {"SPIRAL_EVEN_JITTER", fmt::format("{}u", nielsen ? half / spiral_turns(samples) : half)},
            {"SPIRAL_TURNS_PER_HASH", fmt::format("{}u", wrapped)},  // in 2^-32 turns
            {"SPIRAL_TURNS_PER_FRAME", fmt::format("{}u", turns_per_frame)},
            {"SPIRAL_TURNS_PER_JITTER", fmt::format("{}u", turns_per_jitter)}};  // in 2^-16 turns: tau / N
}

}  // namespace plumb

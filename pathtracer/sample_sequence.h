// The random numbers of one pixel: two-dimensional Sobol points with hash-based Owen scrambling.
//
// Each use of randomness along a path has a `dimension` of its own. Within a dimension the points over all sample
// indices of a half form a scrambled (0, 2)-sequence in base 2; dimensions, pixels and the two halves are decorrelated
// by hashed scramblings and shuffles, so the halves are independent estimates. Any point is found at once from (seed,
// pixel, sample, dimension): nothing depends on the order of work.
//   Sources: Burley 2020, "Practical Hash-based Owen Scrambling"; Laine, Karras 2011 for the permutation, with
//   constants by Vegdahl 2021, "Building a Better LK Hash"; the mixers are those of SplitMix64 (Steele et al. 2014)
//   and, for 32 bits, "lowbias32" (Wellons 2018, "Prospecting for Hash Functions").
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "pathtracer/lanes.h"
#include "pathtracer/sample_points.h"

namespace plumb {

inline std::uint64_t mix_bits(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

PLUMBLINE_INLINE std::uint32_t mix_word(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

PLUMBLINE_INLINE std::uint32_t reverse_bits(std::uint32_t x) {
    x = __builtin_bswap32(x);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

// Flips each bit by a hash of the bits below it.
PLUMBLINE_INLINE std::uint32_t laine_karras_permutation(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// The second Sobol dimension of an index, bits reversed: the product with Pascal's triangle modulo 2, which is a
// Kronecker power of [[1, 0], [1, 1]] and so five masked shifts.
PLUMBLINE_INLINE std::uint32_t reversed_second_sobol_dimension(std::uint32_t index) {
    std::uint32_t x = index;
    x ^= x >> 16;
    x ^= (x & 0xff00ff00u) >> 8;
    x ^= (x & 0xf0f0f0f0u) >> 4;
    x ^= (x & 0xccccccccu) >> 2;
    x ^= (x & 0xaaaaaaaau) >> 1;
    return x;
}

// [0, 1), never 1: the lowest 8 bits are dropped.
PLUMBLINE_INLINE float to_unit_interval(std::uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }

// Names one sample of one pixel: the key tells (seed, pixel, half) from all others.
struct SampleIndex {
    std::uint32_t key_low = 0, key_high = 0;
    std::uint32_t reversed_index = 0;  // within the half, bits reversed
};

// A point of the unit square in units of 2^-32.
struct FixedPoint {
    std::uint32_t x, y;
};

// The point of `sample` in a dimension given as mix_word(dimension). All in 32 bits and without branches, so that a
// loop over lanes becomes vector code.
PLUMBLINE_INLINE FixedPoint fixed_sobol_point(const SampleIndex& sample, std::uint32_t mixed_dimension) {
    const std::uint32_t a = mix_word(mix_word(sample.key_low ^ mixed_dimension) + sample.key_high);
    const std::uint32_t b = mix_word(a + 0x9e3779b9u), c = mix_word(b + 0x9e3779b9u);
    // The permutation takes bits reversed, and the first Sobol dimension is the index reversed: back to the index.
    const std::uint32_t index = reverse_bits(laine_karras_permutation(sample.reversed_index, a));
    return {reverse_bits(laine_karras_permutation(index, b)),
            reverse_bits(laine_karras_permutation(reversed_second_sobol_dimension(index), c))};
}

PLUMBLINE_INLINE glm::vec2 sobol_point(const SampleIndex& sample, std::uint32_t mixed_dimension) {
    const FixedPoint point = fixed_sobol_point(sample, mixed_dimension);
    return {to_unit_interval(point.x), to_unit_interval(point.y)};
}

// The samples of many paths side by side.
struct SampleLanes {
    Lanes<std::uint32_t> key_low, key_high, reversed_index;

    PLUMBLINE_INLINE SampleIndex get(int lane) const { return {key_low[lane], key_high[lane], reversed_index[lane]}; }
    PLUMBLINE_INLINE void set(int lane, const SampleIndex& sample) {
        key_low[lane] = sample.key_low, key_high[lane] = sample.key_high;
        reversed_index[lane] = sample.reversed_index;
    }
};

class SampleSequence {
public:
    SampleSequence(std::uint64_t seed, int x, int y, SamplePoints points = SamplePoints::sobol)
        : points_(points),
          pixel_key_(mix_bits(mix_bits(seed) ^ (static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 32 |
                                                static_cast<std::uint32_t>(x)))) {}

    // Even samples belong to half A, odd ones to half B.
    void start_sample(int sample) {
        // Independent points are each the first of a sequence of its own.
        const bool sobol = points_ == SamplePoints::sobol;
        const std::uint64_t key = mix_bits(pixel_key_ + static_cast<std::uint64_t>(sobol ? sample & 1 : sample));
        index_ = {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32),
                  sobol ? reverse_bits(static_cast<std::uint32_t>(sample >> 1)) : 0};
    }

    // Samples first to first + count - 1, into lanes from `begin` on; what stood up to a group behind them is lost.
    void start_samples(int first, int count, int begin, SampleLanes& lanes) const {
        if (points_ == SamplePoints::random) {
            SampleSequence one = *this;
            for (int i = 0; i < count; ++i) {
                one.start_sample(first + i);
                lanes.set(begin + i, one.index_);
            }
            return;
        }
        const std::uint64_t even = mix_bits(pixel_key_), odd = mix_bits(pixel_key_ + 1);
        const auto low = [](std::uint64_t key) { return static_cast<std::uint32_t>(key); };
        const std::uint32_t lows[] = {low(even), low(odd)}, highs[] = {low(even >> 32), low(odd >> 32)};
        for (int i = 0; i < whole_groups(count); ++i) {
            const auto sample = static_cast<std::uint32_t>(first + i);
            const bool in_half_b = (sample & 1) != 0;
            lanes.key_low[begin + i] = in_half_b ? lows[1] : lows[0];
            lanes.key_high[begin + i] = in_half_b ? highs[1] : highs[0];
            lanes.reversed_index[begin + i] = reverse_bits(sample >> 1);
        }
    }

    const SampleIndex& index() const { return index_; }
    glm::vec2 point(std::uint32_t dimension) const { return sobol_point(index_, mix_word(dimension)); }

private:
    SamplePoints points_;
    std::uint64_t pixel_key_;
    SampleIndex index_;
};

// SampleSequence::point for the first `count` lanes.
inline void sample_points(const SampleLanes& samples, int count, std::uint32_t dimension, Lanes<float>& x,
                          Lanes<float>& y) {
    const std::uint32_t mixed_dimension = mix_word(dimension);
    for (int i = 0; i < whole_groups(count); ++i) {
        const glm::vec2 point = sobol_point(samples.get(i), mixed_dimension);
        x[i] = point.x, y[i] = point.y;
    }
}

// The same with every bit of the first number.
inline void sample_points(const SampleLanes& samples, int count, std::uint32_t dimension, Lanes<std::uint32_t>& x,
                          Lanes<float>& y) {
    const std::uint32_t mixed_dimension = mix_word(dimension);
    for (int i = 0; i < whole_groups(count); ++i) {
        const FixedPoint point = fixed_sobol_point(samples.get(i), mixed_dimension);
        x[i] = point.x, y[i] = to_unit_interval(point.y);
    }
}

// One number each.
inline void sample_numbers(const SampleLanes& samples, int count, std::uint32_t dimension, Lanes<float>& x) {
    const std::uint32_t mixed_dimension = mix_word(dimension);
    for (int i = 0; i < whole_groups(count); ++i) x[i] = sobol_point(samples.get(i), mixed_dimension).x;
}

}  // namespace plumb

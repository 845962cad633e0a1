// The random numbers of one pixel: two-dimensional Sobol points with hash-based Owen scrambling.
//
// Each use of randomness along a path has a `dimension` of its own. Within a dimension the points over all sample
// indices of a half form a scrambled (0, 2)-sequence in base 2; dimensions, pixels and the two halves are decorrelated
// by hashed scramblings and shuffles, so the halves are independent estimates. Any point is found at once from (seed,
// pixel, sample, dimension): nothing depends on the order of work.
//   Sources: Burley 2020, "Practical Hash-based Owen Scrambling"; Laine, Karras 2011 for the permutation, with
//   constants by Vegdahl 2021, "Building a Better LK Hash"; the mixers are those of SplitMix64 (Steele et al. 2014).
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace plumb {

inline std::uint64_t mix_bits(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

inline std::uint32_t reverse_bits(std::uint32_t x) {
    x = __builtin_bswap32(x);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

// Flips each bit by a hash of the bits below it.
inline std::uint32_t laine_karras_permutation(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// The second Sobol dimension of an index whose bits are already reversed (the first dimension): the product with
// Pascal's triangle modulo 2, which is a Kronecker power of [[1, 1], [0, 1]] and so five masked shifts.
inline std::uint32_t second_sobol_dimension(std::uint32_t reversed_index) {
    std::uint32_t x = reversed_index;
    x ^= x << 16;
    x ^= (x & 0x00ff00ffu) << 8;
    x ^= (x & 0x0f0f0f0fu) << 4;
    x ^= (x & 0x33333333u) << 2;
    x ^= (x & 0x55555555u) << 1;
    return x;
}

// [0, 1), never 1: the lowest 8 bits are dropped.
inline float to_unit_interval(std::uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }

class SampleSequence {
public:
    SampleSequence(std::uint64_t seed, int x, int y)
        : pixel_key_(mix_bits(mix_bits(seed) ^ (static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 32 |
                                                static_cast<std::uint32_t>(x)))) {}

    // Even samples belong to half A, odd ones to half B.
    void start_sample(int sample) {
        half_key_ = mix_bits(pixel_key_ + static_cast<std::uint64_t>(sample & 1));
        reversed_index_ = reverse_bits(static_cast<std::uint32_t>(sample >> 1));
    }

    glm::vec2 point(std::uint32_t dimension) const {
        const std::uint64_t a = mix_bits(half_key_ + dimension);
        const std::uint64_t b = mix_bits(a);
        // The shuffled index, reversed, is the first Sobol dimension.
        const std::uint32_t index = laine_karras_permutation(reversed_index_, static_cast<std::uint32_t>(a));
        return {scrambled(index, static_cast<std::uint32_t>(a >> 32)),
                scrambled(second_sobol_dimension(index), static_cast<std::uint32_t>(b))};
    }

    float number(std::uint32_t dimension) const {
        const std::uint64_t a = mix_bits(half_key_ + dimension);
        const std::uint32_t index = laine_karras_permutation(reversed_index_, static_cast<std::uint32_t>(a));
        return scrambled(index, static_cast<std::uint32_t>(a >> 32));
    }

private:
    static float scrambled(std::uint32_t x, std::uint32_t seed) {
        return to_unit_interval(reverse_bits(laine_karras_permutation(reverse_bits(x), seed)));
    }

    std::uint64_t pixel_key_;
    std::uint64_t half_key_ = 0;
    std::uint32_t reversed_index_ = 0;
};

}  // namespace plumb

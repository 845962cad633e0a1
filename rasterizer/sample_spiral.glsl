// The GLSL half of sample_spiral.h, which has the formulas and makes the block's contents and the defines.
#include "view.glsl"

layout(std140, binding = SPIRAL_BINDING) uniform SpiralBlock {
    vec4 tap_directions[SPIRAL_MAXIMUM_SAMPLES / 2];
    vec4 spin_directions[SPIRAL_SPIN_COUNT / 2];
};

uint spiral_hash(uvec2 p) {
    uint h = p.x * 0x9E3779B1u ^ p.y * 0x85EBCA77u;
    h = (h ^ (h >> 15)) * 0xC2B2AE3Du;
    return (h ^ (h >> 13)) * 0x27D4EB2Fu;
}

// The rotation (cosine, sine) of all taps of a pixel; `jitter` is in 2^-16.
vec2 spiral_spin(ivec2 pixel, uint jitter) {
    uvec2 p = uvec2(pixel + pattern_shift);
#if SPIRAL_NIELSEN2015
    uint spin = spiral_hash(p);
#else
    uint spin = ((3u * p.x) ^ (p.y + p.x * p.y)) * SPIRAL_TURNS_PER_HASH;
#endif
    uint turns = spin + jitter * SPIRAL_TURNS_PER_JITTER + uint(frame_number) * SPIRAL_TURNS_PER_FRAME;
    uint index = turns >> (32 - SPIRAL_SPIN_BITS);
    vec4 pair = spin_directions[index >> 1];
    return (index & 1u) == 0u ? pair.xy : pair.zw;
}

// The unit direction of tap i, spun.
vec2 spiral_direction(int i, vec2 spin) {
    vec4 pair = tap_directions[i >> 1];
    vec2 tap = (i & 1) == 0 ? pair.xy : pair.zw;
    return vec2(tap.x * spin.x - tap.y * spin.y, tap.x * spin.y + tap.y * spin.x);
}

// Of a pixel, in 2^-16: 0.1 to 0.9 from its hash, or that of every pixel where the pattern has but one.
uint spiral_jitter(ivec2 pixel) {
#if SPIRAL_NIELSEN2015
    return SPIRAL_EVEN_JITTER;
#else
    return 6554u + ((spiral_hash(uvec2(pixel + pattern_shift)) >> 16) * 52428u >> 16);
#endif
}

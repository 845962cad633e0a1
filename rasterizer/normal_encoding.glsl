// Unit vectors in a texture's channels; normal_encoding.h says what each encoding costs and loses.
//
// Define: NORMAL_ENCODING, one of the names below; without it OCTAHEDRAL. The C++ counterparts are in normal_encoding.h.
#include "view.glsl"

#define OCTAHEDRAL 0
#define SIGNED_VECTOR 1
#define UNSIGNED_VECTOR 2
#define CAMERA_XY 3
#ifndef NORMAL_ENCODING
#define NORMAL_ENCODING OCTAHEDRAL
#endif

// Zero, which a texture holds where nothing is, stays finite.
vec3 unit(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-20)); }

vec2 encode_normal(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0) p = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return 0.5 * p + 0.5;
}

vec3 decode_normal(vec2 encoded) {
    vec2 p = 2.0 * encoded - 1.0;
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    float fold = max(-n.z, 0.0);
    n.xy += vec2(n.x >= 0.0 ? -fold : fold, n.y >= 0.0 ? -fold : fold);
    return normalize(n);
}

// The texel of the plane `normal` that keeps the world-space unit vector n.
vec4 texel_of_normal(vec3 n) {
#if NORMAL_ENCODING == OCTAHEDRAL
    return vec4(encode_normal(n), 0.0, 0.0);
#elif NORMAL_ENCODING == SIGNED_VECTOR
    return vec4(n, 0.0);
#elif NORMAL_ENCODING == UNSIGNED_VECTOR
    return vec4(0.5 * n + 0.5, 0.0);
#elif NORMAL_ENCODING == CAMERA_XY
    return vec4(0.5 * camera_space_direction(n).xy + 0.5, 0.0, 0.0);
#endif
}

vec3 normal_of_texel(vec4 texel) {
#if NORMAL_ENCODING == OCTAHEDRAL
    return decode_normal(texel.xy);
#elif NORMAL_ENCODING == SIGNED_VECTOR
    return unit(texel.xyz);
#elif NORMAL_ENCODING == UNSIGNED_VECTOR
    return unit(2.0 * texel.xyz - 1.0);
#elif NORMAL_ENCODING == CAMERA_XY
    vec2 xy = 2.0 * texel.xy - 1.0;
    return unit(world_space_direction(vec3(xy, sqrt(max(0.0, 1.0 - dot(xy, xy))))));
#endif
}

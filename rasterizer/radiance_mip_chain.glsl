// Reading the radiance MIP chain; radiance_mip_chain.h says how it is made.
layout(binding = 7) uniform sampler2DArray radiance_chain;

// Sums to 1 where all four texels hold surfaces.
vec4 chain_level(vec2 pixel, int layer, int level) {
    ivec2 last = max(ivec2(view_size) >> level, 1) - 1;
    vec2 at = pixel / float(1 << level) - 0.5;
    ivec2 corner = ivec2(floor(at));
    vec2 part = at - vec2(corner);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 side = ivec2(i & 1, i >> 1);
        vec2 weight = mix(1.0 - part, part, vec2(side));
        sum += weight.x * weight.y *
               texelFetch(radiance_chain, ivec3(clamp(corner + side, ivec2(0), last), layer), level);
    }
    return sum;
}

// The mean over about 2^level pixels squared around `pixel`, of what holds surfaces: in rgb the sum, in a its weight.
vec4 chain_radiance(vec2 pixel, int layer, float level) {
    float clamped = clamp(level, 0.0, float(COARSEST_RADIANCE_LEVEL));
    int finer = min(int(clamped), COARSEST_RADIANCE_LEVEL);
    vec4 fine = chain_level(pixel, layer, finer);
    float part = clamped - float(finer);
    return part > 0.0 ? mix(fine, chain_level(pixel, layer, finer + 1), part) : fine;
}

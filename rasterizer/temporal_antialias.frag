// One frame of temporal anti-aliasing; temporal_antialias.h has the formula.
//
// Defines: LEAST_WEIGHT (1 - alpha), CLAMP_HISTORY, REPROJECT, DILATE, CATMULL_ROM (0, 1; those two matter where
// REPROJECT is 1), MARGIN (pixels on each side that are not resolved), and that of reprojection.glsl.
#include "reprojection.glsl"

layout(binding = 0) uniform sampler2DArray aliased;
#if REPROJECT
layout(binding = 1) uniform sampler2DArray depth_plane;
#endif
layout(binding = 2) uniform sampler2DArray history;  // alpha: over how many frames it is averaged
uniform bool has_history;

layout(location = 0) out vec4 resolved;

ivec2 first_pixel = ivec2(MARGIN);
ivec2 last_pixel = ivec2(view_size) - 1 - MARGIN;

ivec2 within(ivec2 pixel) { return clamp(pixel, first_pixel, last_pixel); }
vec4 history_at(ivec2 pixel) { return texelFetch(history, ivec3(within(pixel), 0), 0); }

#if REPROJECT
// `place` as gl_FragCoord.xy counts.
vec4 bilinear_history(vec2 place) {
    vec2 corner = floor(place - 0.5), fraction = place - 0.5 - corner;
    ivec2 p = ivec2(corner);
    return mix(mix(history_at(p), history_at(p + ivec2(1, 0)), fraction.x),
               mix(history_at(p + ivec2(0, 1)), history_at(p + ivec2(1, 1)), fraction.x), fraction.y);
}

// Weights of the four pixels of a row around a place that lies `t` between the two in the middle.
vec4 catmull_rom_weights(float t) {
    float t2 = t * t, t3 = t2 * t;
    return 0.5 * vec4(-t3 + 2.0 * t2 - t, 3.0 * t3 - 5.0 * t2 + 2.0, -3.0 * t3 + 4.0 * t2 + t, t3 - t2);
}

vec4 catmull_rom_history(vec2 place) {
    vec2 corner = floor(place - 0.5), fraction = place - 0.5 - corner;
    vec4 columns = catmull_rom_weights(fraction.x), rows = catmull_rom_weights(fraction.y);
    vec4 sum = vec4(0.0);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) sum += columns[x] * rows[y] * history_at(ivec2(corner) + ivec2(x, y) - 1);
    }
    return max(sum, vec4(0.0));  // negative lobes must not leave less than no light
}

// Where the surface of `surface`, `depth` metres away, was when its motion is that of this pixel. False: behind the
// camera or outside the image.
bool moved_place(ivec2 surface, float depth, out vec2 place) {
    PreviousPlace previous = previous_place(surface, 0, depth);
    // Between the views without their offsets, in pixels.
    vec2 now = vec2(surface) + 0.5 + 0.5 * view_size * view_shift;
    vec2 then = previous.pixel + 0.5 * view_size * previous_view_shift;
    place = gl_FragCoord.xy + then - now;
    return previous.in_front && !any(lessThan(place, vec2(first_pixel))) &&
           !any(greaterThan(place, vec2(last_pixel + 1)));
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 colour = texelFetch(aliased, ivec3(pixel, 0), 0).rgb;
    resolved = vec4(colour, 1.0);
    if (!has_history) return;

    vec3 least = colour, greatest = colour;
#if REPROJECT
    ivec2 surface = pixel;
    float depth = texelFetch(depth_plane, ivec3(pixel, 0), 0).r;
#endif
    for (int i = 0; i < 9; ++i) {
        ivec2 neighbour = within(pixel + ivec2(i % 3, i / 3) - 1);
#if CLAMP_HISTORY
        vec3 other = texelFetch(aliased, ivec3(neighbour, 0), 0).rgb;
        least = min(least, other);
        greatest = max(greatest, other);
#endif
#if DILATE
        float other_depth = texelFetch(depth_plane, ivec3(neighbour, 0), 0).r;
        if (other_depth < depth) {
            depth = other_depth;
            surface = neighbour;
        }
#endif
    }

#if REPROJECT
    vec2 place;
    if (!moved_place(surface, depth, place)) return;
#if CATMULL_ROM
    vec4 kept = catmull_rom_history(place);
#else
    vec4 kept = bilinear_history(place);
#endif
#else
    vec4 kept = history_at(pixel);
#endif
#if CLAMP_HISTORY
    kept.rgb = clamp(kept.rgb, least, greatest);
#endif
    float frames = kept.a + 1.0;
    resolved = vec4(mix(kept.rgb, colour, max(LEAST_WEIGHT, 1.0 / frames)), frames);
}

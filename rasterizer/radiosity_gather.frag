// The light that the visible layers send to each pixel of one of them; radiosity_gather.h has the formulas.
//
// Defines: RECEIVER_LAYER, LAYERS (that taps look at), SENDING_LAYERS (of these: that send light), ESTIMATOR and
// NORMALISATION with the names of their values, TAPS (in all), TEST_TAP_NORMAL, FAR_TAPS_HIT and EMITTERS_SHINE (0, 1),
// MIP_NORMALS_AND_RADIANCE (0, 1), RADIUS (metres), SPREAD_PIXELS (0: the radius as it projects), MIP_OFFSET,
// FINEST_LEVEL, COARSEST_LEVEL, POINTS_AT_TAPS (0, 1: points of coarser levels, too), and those of falloff.glsl and
// sample_spiral.glsl.

#include "depth_mip_chain.glsl"
#include "falloff.glsl"
#include "normal_encoding.glsl"
#include "sample_spiral.glsl"

layout(binding = 0) uniform sampler2DArray depth;  // with its MIP chain where COARSEST_LEVEL > 0
layout(binding = 1) uniform sampler2DArray normal;
#if MIP_NORMALS_AND_RADIANCE
layout(binding = 5) uniform sampler2DArray normal_chain;
#define tap_normals normal_chain
#else
#define tap_normals normal
#endif
layout(binding = 2) uniform sampler2DArray radiance;  // reflected and diffuse, of each layer
#if EMITTERS_SHINE
layout(binding = 4) uniform sampler2DArray emission;
#endif

layout(location = 0) out vec4 irradiance;  // rgb: E; a: confidence

struct Tap {
    ivec2 texel;   // of the level
    ivec2 source;  // the pixel of level 0 that it holds
    ivec2 place;   // the pixel whose ray its point lies on
    int level;
};

// Of a plane of level 0, or of its chain.
vec4 tap_texel(sampler2DArray plane, Tap tap, int layer) {
#if MIP_NORMALS_AND_RADIANCE
    return texelFetch(plane, ivec3(tap.texel, layer), tap.level);
#else
    return texelFetch(plane, ivec3(tap.source, layer), 0);
#endif
}

vec3 sent_light(Tap tap, int layer) {
    vec3 light = layer < SENDING_LAYERS ? tap_texel(radiance, tap, layer).rgb : vec3(0.0);
#if EMITTERS_SHINE
    light += tap_texel(emission, tap, layer).rgb;
#endif
    return light;
}

// The light that a tap sends, before 2 pi / M; in alpha whether it counts as a hit.
vec4 received(Tap tap, int layer, vec3 centre, vec3 camera_normal) {
    float tap_depth = texelFetch(depth, ivec3(tap.texel, layer), tap.level).r;
    vec3 offset = surface_point(tap.place, layer, tap_depth) - centre;
    float square = dot(offset, offset);
    vec3 direction = offset * inversesqrt(max(square, 1e-30));
    float cosine = dot(direction, camera_normal);
    bool near = square < RADIUS * RADIUS;
    // The shaded point itself has no direction; rounding would make one up.
    bool hit = !is_background(tap_depth) && cosine > 0.0 && square > 1e-12 * centre.z * centre.z;
#if TEST_TAP_NORMAL
    vec3 tap_normal = normal_of_texel(tap_texel(tap_normals, tap, layer));
    hit = hit && -dot(world_space_direction(direction), tap_normal) > 0.01;
#endif
#if !FAR_TAPS_HIT
    hit = hit && near;
#endif
    vec3 light = sent_light(tap, layer);
    return hit ? vec4(near ? cosine * falloff(square * (1.0 / (RADIUS * RADIUS))) * light : vec3(0.0), 1.0) : vec4(0.0);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centre_depth = texelFetch(depth, ivec3(pixel, RECEIVER_LAYER), 0).r;
    irradiance = vec4(0.0);
    if (is_background(centre_depth)) return;

    vec3 camera_normal = camera_space_direction(normal_of_texel(texelFetch(normal, ivec3(pixel, RECEIVER_LAYER), 0)));
    vec3 centre = surface_point(pixel, RECEIVER_LAYER, centre_depth);
    uint jitter = spiral_jitter(pixel);
    vec2 spin = spiral_spin(pixel, jitter);
#if SPREAD_PIXELS > 0
    float tap_spacing = float(SPREAD_PIXELS) / float(SPIRAL_SAMPLES);
#else
    float tap_spacing = radius_in_pixels(RADIUS, centre_depth) / float(SPIRAL_SAMPLES);
#endif
    float first_tap = float(jitter) / 65536.0;

    vec4 sum = vec4(0.0);
    for (int i = 0; i < SPIRAL_SAMPLES; ++i) {
        float distance = (float(i) + first_tap) * tap_spacing;
        ivec2 position = pixel + ivec2(floor(distance * spiral_direction(i, spin) + 0.5));
        Tap tap;
        tap.level = mip_level(distance, MIP_OFFSET, FINEST_LEVEL, COARSEST_LEVEL);
        tap.texel = texel_at(position, tap.level);
        tap.source = pixel_of_texel(tap.texel, tap.level);
#if POINTS_AT_TAPS
        tap.place = position;
#else
        tap.place = tap.source;
#endif
        vec4 light = received(tap, 0, centre, camera_normal);
#if LAYERS == 2
        vec4 second = received(tap, 1, centre, camera_normal);
#if ESTIMATOR == MARA2016
        bool second_wins = dot(second.rgb, second.rgb) > dot(light.rgb, light.rgb);
        light = vec4(second_wins ? second.rgb : light.rgb, max(light.a, second.a));
#elif ESTIMATOR == NIELSEN2015
        light += second;
#endif
#endif
        sum += is_inside(position) ? light : vec4(0.0);
    }

#if NORMALISATION == HITS
    float divisor = max(sum.a, 1.0);
#elif NORMALISATION == SAMPLES
    float divisor = float(TAPS);
#endif
    irradiance = vec4(2.0 * 3.14159265 / divisor * sum.rgb, sum.a / float(TAPS));
}

// Ambient visibility of each pixel of layer 0; ambient_obscurance.h has the formulas and the names of the estimators.
//
// Defines: LAYERS, ESTIMATOR with the names of its values, FACE_NORMALS (0, 1), G3D_NORMALS (0, 1: of these, those as
// G3D has them), LONGEST_NORMAL (of these, over the square of the depth), RADIUS (metres), SPREAD_PIXELS (0: the
// radius as it projects), LEAST_SINE (of a hit over the tangent plane), BIAS, EPSILON (square metres), INTENSITY,
// EXPONENT, MIP_OFFSET, COARSEST_LEVEL, POINTS_AT_TAPS (0, 1: points of coarser levels, too), and those of falloff.glsl and sample_spiral.glsl.

#include "depth_mip_chain.glsl"
#include "falloff.glsl"
#include "normal_encoding.glsl"
#include "sample_spiral.glsl"

layout(binding = 0) uniform sampler2DArray depth;  // with its MIP chain where COARSEST_LEVEL > 0
layout(binding = 1) uniform sampler2DArray normal;

layout(location = 0) out float visibility;

struct Receiver {
    vec3 point, normal;  // camera space
    float bias;
};

// Of the point that `pixel` shows in a layer, and in y whether it counts as a hit (NIELSEN2015). Without a surface it is
// so far away that its falloff is 0.
vec2 obscurance(ivec2 pixel, int layer, float tap_depth, Receiver receiver) {
    vec3 offset = surface_point(pixel, layer, tap_depth) - receiver.point;
    float square = dot(offset, offset);
    float weight = falloff(square * (1.0 / (RADIUS * RADIUS)));
    float elevation = dot(offset, receiver.normal);
#if ESTIMATOR == NIELSEN2015
    float sine = elevation * inversesqrt(max(square, 1e-30));
    float hit = sine > LEAST_SINE && weight > 0.0 ? 1.0 : 0.0;
    return vec2(hit * weight * max(0.0, sine - receiver.bias) / (square + EPSILON), hit);
#else
    float height = max(0.0, elevation - receiver.bias);
#if ESTIMATOR == SAO2012 || ESTIMATOR == ALCHEMY2011
    return vec2(weight * height / (square + EPSILON), 1.0);
#elif ESTIMATOR == SAO2012_UNDIVIDED
    return vec2(weight * height, 1.0);
#else
    return vec2(weight * height * inversesqrt(square + EPSILON), 1.0);
#endif
#endif
}

// pow leaves 0 to the power of 0 open, whose limit here is 1: without intensity or exponent nothing is obscured.
float power(float base, float exponent) { return exponent == 0.0 ? 1.0 : pow(base, exponent); }

float visibility_from(float mean, vec3 camera_normal) {
#if ESTIMATOR == MARA2016
    return max(0.0, 1.0 - INTENSITY * sqrt(3.14159265 * mean));
#elif ESTIMATOR == G3D_DEMO
    float facing = mix(1.0, max(0.0, 1.5 * camera_normal.z), 0.35);
    return power(max(0.0, 1.0 - sqrt(3.0 * mean * facing)), INTENSITY);
#elif ESTIMATOR == SAO2012 || ESTIMATOR == SAO2012_UNDIVIDED
#if ESTIMATOR == SAO2012_UNDIVIDED
    mean *= FALLOFF == HARD ? 2.0 : 4.0;
#endif
    float plain = max(0.0, 1.0 - 5.0 * INTENSITY * mean);
    return (pow(plain, 0.2) + 1.2 * plain * plain * plain * plain) / 2.2;
#elif ESTIMATOR == ALCHEMY2011 || ESTIMATOR == NIELSEN2015
    return power(max(0.0, 1.0 - 2.0 * INTENSITY * mean), EXPONENT);
#elif ESTIMATOR == LINEAR
    return max(0.0, 1.0 - 2.0 * INTENSITY * mean);
#endif
}

#if G3D_NORMALS
// By the differences within the 2 by 2 pixels; 0 where there is none, or they reach too far.
vec3 face_normal(ivec2 pixel, float centre_depth, vec3 centre) {
    ivec2 beside = pixel ^ ivec2(1, 0), above = pixel ^ ivec2(0, 1);
    if (!is_inside(beside) || !is_inside(above)) return vec3(0.0);
    float depth_beside = texelFetch(depth, ivec3(beside, 0), 0).r, depth_above = texelFetch(depth, ivec3(above, 0), 0).r;
    if (is_background(depth_beside) || is_background(depth_above)) return vec3(0.0);
    vec3 normal = cross(surface_point(beside, 0, depth_beside) - centre, surface_point(above, 0, depth_above) - centre);
    float square = dot(normal, normal), longest = LONGEST_NORMAL * centre_depth * centre_depth;
    if (square == 0.0 || square > longest * longest) return vec3(0.0);
    // Differences to the right and upwards make a normal towards the camera.
    bool one_is_backwards = ((pixel.x ^ pixel.y) & 1) == 1;
    return normal * (inversesqrt(square) * (one_is_backwards ? -1.0 : 1.0));
}
#elif FACE_NORMALS
// From the pixel to the one of its two neighbours along an axis whose depth is nearer; 0 where neither shows anything.
vec3 step_along(ivec2 pixel, ivec2 axis, float centre_depth, vec3 centre) {
    ivec2 ahead = pixel + axis, behind = pixel - axis;
    float none = 1.0 / 0.0;
    float depth_ahead = is_inside(ahead) ? texelFetch(depth, ivec3(ahead, 0), 0).r : none;
    float depth_behind = is_inside(behind) ? texelFetch(depth, ivec3(behind, 0), 0).r : none;
    if (is_background(depth_ahead) && is_background(depth_behind)) return vec3(0.0);
    return abs(depth_ahead - centre_depth) <= abs(depth_behind - centre_depth)
               ? surface_point(ahead, 0, depth_ahead) - centre
               : centre - surface_point(behind, 0, depth_behind);
}

vec3 face_normal(ivec2 pixel, float centre_depth, vec3 centre) {
    vec3 normal = cross(step_along(pixel, ivec2(1, 0), centre_depth, centre),
                        step_along(pixel, ivec2(0, 1), centre_depth, centre));
    float square = dot(normal, normal);
    if (square == 0.0) return vec3(0.0);
    return normal * (inversesqrt(square) * (dot(normal, centre) > 0.0 ? -1.0 : 1.0));
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centre_depth = texelFetch(depth, ivec3(pixel, 0), 0).r;
    visibility = 1.0;
    float radius_pixels = radius_in_pixels(RADIUS, centre_depth);
#if SPREAD_PIXELS > 0
    radius_pixels = float(SPREAD_PIXELS);
#endif
    if (is_background(centre_depth) || radius_pixels < 1.0) return;

    Receiver receiver;
    receiver.point = surface_point(pixel, 0, centre_depth);
#if FACE_NORMALS
    receiver.normal = face_normal(pixel, centre_depth, receiver.point);
    if (receiver.normal == vec3(0.0)) return;
#else
    receiver.normal = camera_space_direction(normal_of_texel(texelFetch(normal, ivec3(pixel, 0), 0)));
#endif
    receiver.bias = BIAS;
#if ESTIMATOR == ALCHEMY2011 || ESTIMATOR == NIELSEN2015
    receiver.bias *= centre_depth;
#endif
    vec2 spin = spiral_spin(pixel, SPIRAL_EVEN_JITTER);
    const float first_tap = float(SPIRAL_EVEN_JITTER) / 65536.0;
    float tap_spacing = radius_pixels / float(SPIRAL_SAMPLES);

    vec2 sum = vec2(0.0);
    for (int i = 0; i < SPIRAL_SAMPLES; ++i) {
        float distance = (float(i) + first_tap) * tap_spacing;
#if ESTIMATOR == G3D_DEMO
        distance = max(distance, 0.75);
#endif
        ivec2 tap = pixel + ivec2(floor(distance * spiral_direction(i, spin) + 0.5));
        int level = mip_level(distance, MIP_OFFSET, 0, COARSEST_LEVEL);
        ivec2 texel = texel_at(tap, level);
#if POINTS_AT_TAPS
        ivec2 source = tap;
#else
        ivec2 source = pixel_of_texel(texel, level);
#endif
        vec2 found = obscurance(source, 0, texelFetch(depth, ivec3(texel, 0), level).r, receiver);
#if LAYERS == 2
        vec2 behind = obscurance(source, 1, texelFetch(depth, ivec3(texel, 1), level).r, receiver);
#if ESTIMATOR == NIELSEN2015
        found += behind;
#else
        found = max(found, behind);
#endif
#endif
        sum += is_inside(tap) ? found : vec2(0.0);
    }

#if ESTIMATOR == NIELSEN2015
    float mean = sum.x / max(sum.y, 1.0);
#else
    float mean = sum.x / float(SPIRAL_SAMPLES);
#endif
    visibility = visibility_from(mean, receiver.normal);
#if ESTIMATOR == G3D_DEMO
    visibility = mix(1.0, visibility, clamp(radius_pixels - 3.0, 0.0, 1.0));
#endif
}

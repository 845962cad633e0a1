// Ambient visibility of each pixel of layer 0; ambient_obscurance.h has the formulas and the names of the estimators.
//
// Defines: LAYERS, ESTIMATOR with the names of its values, RADIUS (metres), BIAS (metres), EPSILON (square metres),
// INTENSITY, MIP_OFFSET, COARSEST_LEVEL, and those of falloff.glsl and sample_spiral.glsl.

#include "depth_mip_chain.glsl"
#include "falloff.glsl"
#include "normal_encoding.glsl"
#include "sample_spiral.glsl"

layout(binding = 0) uniform sampler2DArray depth;  // with its MIP chain where COARSEST_LEVEL > 0
layout(binding = 1) uniform sampler2DArray normal;

layout(location = 0) out float visibility;

// Of the point that `pixel` shows in a layer. Without a surface it is so far away that its falloff is 0.
float obscurance(ivec2 pixel, int layer, float tap_depth, vec3 centre, vec3 camera_normal) {
    vec3 offset = surface_point(pixel, layer, tap_depth) - centre;
    float square = dot(offset, offset);
    float height = max(0.0, dot(offset, camera_normal) - BIAS);
#if ESTIMATOR == SAO2012
    return falloff(square * (1.0 / (RADIUS * RADIUS))) * height / (square + EPSILON);
#else
    return falloff(square * (1.0 / (RADIUS * RADIUS))) * height * inversesqrt(square + EPSILON);
#endif
}

float visibility_from(float mean, vec3 camera_normal) {
#if ESTIMATOR == MARA2016
    return max(0.0, 1.0 - INTENSITY * sqrt(3.14159265 * mean));
#elif ESTIMATOR == G3D_DEMO
    float facing = mix(1.0, max(0.0, 1.5 * camera_normal.z), 0.35);
    return pow(max(0.0, 1.0 - sqrt(3.0 * mean * facing)), INTENSITY);
#elif ESTIMATOR == SAO2012
    float plain = max(0.0, 1.0 - 5.0 * INTENSITY * mean);
    return (pow(plain, 0.2) + 1.2 * plain * plain * plain * plain) / 2.2;
#elif ESTIMATOR == LINEAR
    return max(0.0, 1.0 - 2.0 * INTENSITY * mean);
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centre_depth = texelFetch(depth, ivec3(pixel, 0), 0).r;
    visibility = 1.0;
    float radius_pixels = radius_in_pixels(RADIUS, centre_depth);
    if (is_background(centre_depth) || radius_pixels < 1.0) return;

    vec3 camera_normal = camera_space_direction(normal_of_texel(texelFetch(normal, ivec3(pixel, 0), 0)));
    vec3 centre = surface_point(pixel, 0, centre_depth);
    vec2 spin = spiral_spin(pixel, SPIRAL_JITTER_HALF);
    float tap_spacing = radius_pixels / float(SPIRAL_SAMPLES);

    float sum = 0.0;
    for (int i = 0; i < SPIRAL_SAMPLES; ++i) {
        float distance = (float(i) + 0.5) * tap_spacing;
#if ESTIMATOR == G3D_DEMO
        distance = max(distance, 0.75);
#endif
        ivec2 tap = pixel + ivec2(floor(distance * spiral_direction(i, spin) + 0.5));
        int level = mip_level(distance, MIP_OFFSET, 0, COARSEST_LEVEL);
        ivec2 texel = texel_at(tap, level);
        ivec2 source = pixel_of_texel(texel, level);
        float larger = obscurance(source, 0, texelFetch(depth, ivec3(texel, 0), level).r, centre, camera_normal);
#if LAYERS == 2
        larger = max(larger, obscurance(source, 1, texelFetch(depth, ivec3(texel, 1), level).r, centre, camera_normal));
#endif
        sum += is_inside(tap) ? larger : 0.0;
    }

    visibility = visibility_from(sum / float(SPIRAL_SAMPLES), camera_normal);
#if ESTIMATOR == G3D_DEMO
    visibility = mix(1.0, visibility, clamp(radius_pixels - 3.0, 0.0, 1.0));
#endif
}

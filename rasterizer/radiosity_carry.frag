// What the layers send into this frame's bounce: direct light, and what they reflect of the light of the frame before.
// radiosity_carry.h has the formulas.
//
// Defines: LAYERS, SECOND_LAYER with the names of its values, KEPT_LAYERS (that hold an E of the frame before),
// DAMPING, CARRY_FROM, CARRY_TO (metres), CARRY_IS_CUT (the two are the same), and those of radiosity_boost.glsl and
// reprojection.glsl.

#include "radiosity_boost.glsl"
#include "reprojection.glsl"

layout(binding = 0) uniform sampler2DArray depth;
layout(binding = 1) uniform sampler2DArray previous_depth;
layout(binding = 2) uniform sampler2DArray direct;
layout(binding = 3) uniform sampler2DArray albedo;
layout(binding = 4) uniform sampler2DArray previous_irradiance;
uniform bool continues;  // the planes of the frame before are those of the frame before this one

layout(location = 0) out vec3 sent;
#if LAYERS == 2
layout(location = 1) out vec3 sent_by_second_layer;
#endif

float found_again(float distance) {
#if CARRY_IS_CUT
    return distance < CARRY_FROM ? 1.0 : 0.0;
#else
    return 1.0 - smoothstep(CARRY_FROM, CARRY_TO, distance);
#endif
}

// What is carried on of the irradiance of the point that `pixel` shows in a layer.
vec3 carried(ivec2 pixel, int layer) {
    float depth_now = texelFetch(depth, ivec3(pixel, layer), 0).r;
    if (!continues || is_background(depth_now)) return vec3(0.0);
    PreviousPlace place = previous_place(pixel, layer, depth_now);
    bool inside = all(greaterThanEqual(place.pixel, vec2(0.0))) && all(lessThan(place.pixel, view_size));
    if (!place.in_front || !inside) return vec3(0.0);
    ivec2 then = ivec2(place.pixel);
    float nearest = 1.0 / 0.0;
    int source = 0;
    for (int kept = 0; kept < KEPT_LAYERS; ++kept) {
        float depth_then = texelFetch(previous_depth, ivec3(then, kept), 0).r;
        if (is_background(depth_then)) continue;
        float distance = length(previous_camera_space_point(vec2(then) + 0.5, depth_then) - place.point);
        if (distance < nearest) {
            nearest = distance;
            source = kept;
        }
    }
    float weight = found_again(nearest);
    if (weight <= 0.0) return vec3(0.0);
    return (1.0 - DAMPING) * weight * boosted(texelFetch(previous_irradiance, ivec3(then, source), 0).rgb);
}

vec3 sent_by(ivec2 pixel, int layer, vec3 irradiance) {
    vec3 reflectance = texelFetch(albedo, ivec3(pixel, layer), 0).rgb / 3.14159265;
    return texelFetch(direct, ivec3(pixel, layer), 0).rgb + reflectance * irradiance;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 first = carried(pixel, 0);
    sent = sent_by(pixel, 0, first);
#if LAYERS == 2
#if SECOND_LAYER == REUSE
    vec3 second = first;
#elif SECOND_LAYER == GATHER
    vec3 second = carried(pixel, 1);
#elif SECOND_LAYER == NONE
    vec3 second = vec3(0.0);
#endif
    sent_by_second_layer = sent_by(pixel, 1, second);
#endif
}

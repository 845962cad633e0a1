// One frame of the temporal filter; temporal_filter.h has the formula.
//
// Defines: ALPHA, FROM_PLANE (0, 1: distances are those from the plane, not from the point), REJECT_FROM, REJECT_TO
// (metres), HARD_CUT (0, 1: the two are equal), LAYER (whose surfaces), LAYERS, MARGIN (pixels on each side of which
// there is no history), WRITE_WEIGHT, and that of reprojection.glsl.
#include "normal_encoding.glsl"
#include "reprojection.glsl"

layout(binding = 0) uniform sampler2DArray noisy;
layout(binding = 1) uniform sampler2DArray depth_plane;
layout(binding = 2) uniform sampler2DArray normal_plane;
layout(binding = 3) uniform sampler2DArray previous_depth;
layout(binding = 4) uniform sampler2DArray history;
uniform bool has_history;

layout(location = 0) out vec4 accumulated;
#ifdef WRITE_WEIGHT
layout(location = 1) out float history_weight;
#endif

// What is left of the weight at a distance in metres.
float acceptance(float distance) {
#if HARD_CUT
    return distance <= REJECT_FROM ? 1.0 : 0.0;
#else
    return 1.0 - smoothstep(REJECT_FROM, REJECT_TO, distance);
#endif
}

// Of what the frame before showed in a pixel from a depth.
float depth_difference(ivec2 pixel, float expected) {
    float difference = abs(texelFetch(previous_depth, ivec3(pixel, LAYER), 0).r - expected);
#if LAYERS == 2
    difference = min(difference, abs(texelFetch(previous_depth, ivec3(pixel, 1 - LAYER), 0).r - expected));
#endif
    return difference;
}

#if FROM_PLANE
// Of the surface that a pixel of the frame before showed from the plane through `point` (previous camera space).
float distance_from_plane(ivec2 pixel, vec3 point, vec3 normal) {
    vec3 ray = previous_camera_space_point(vec2(pixel) + 0.5, 1.0);
    float expected = dot(normal, point) / dot(normal, ray);
    // Nearly edge-on the plane is met anywhere, or nowhere.
    if (!(expected > -0.5 * point.z && expected < -2.0 * point.z)) expected = -point.z;
    return depth_difference(pixel, expected) * length(ray);
}
#else
// Of what the frame before showed in a point's place from the point: both lie on one ray.
float distance_from_point(ivec2 pixel, vec3 point) {
    return depth_difference(pixel, -point.z) * length(point) / -point.z;
}
#endif

bool has_kept(ivec2 pixel) {
    return all(greaterThanEqual(pixel, ivec2(MARGIN))) && all(lessThan(pixel, ivec2(view_size) - MARGIN));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 value = texelFetch(noisy, ivec3(pixel, LAYER), 0);
    accumulated = value;
#ifdef WRITE_WEIGHT
    history_weight = 0.0;
#endif
    float depth = texelFetch(depth_plane, ivec3(pixel, LAYER), 0).r;
    if (!has_history || is_background(depth)) return;
    PreviousPlace place = previous_place(pixel, LAYER, depth);
    // Far outside, coordinates would overflow as integers.
    if (!place.in_front || any(lessThan(place.pixel, vec2(-1.0))) || any(greaterThan(place.pixel, view_size + 1.0))) {
        return;
    }
#if FROM_PLANE
    vec3 normal = normal_of_texel(texelFetch(normal_plane, ivec3(pixel, LAYER), 0));
    normal = mat3(previous_camera_from_camera) * camera_space_direction(previous_normal(pixel, LAYER, normal));
#else
    ivec2 then = ivec2(floor(place.pixel));
    if (!has_kept(then)) return;
    float distance = distance_from_point(then, place.point);
#endif

    vec2 corner = floor(place.pixel - 0.5);
    vec2 fraction = place.pixel - 0.5 - corner;
    vec4 difference = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 side = ivec2(i & 1, i >> 1);
        ivec2 tap = ivec2(corner) + side;
        vec2 share = mix(1.0 - fraction, fraction, vec2(side));
        float weight = share.x * share.y;
        if (!has_kept(tap) || weight == 0.0) continue;
#if FROM_PLANE
        float distance = distance_from_plane(tap, place.point, normal);
#endif
        weight *= ALPHA * acceptance(distance);
        if (weight == 0.0) continue;
        difference += weight * (texelFetch(history, ivec3(tap, LAYER), 0) - value);
        total += weight;
    }
    accumulated = value + difference;
#ifdef WRITE_WEIGHT
    history_weight = total;
#endif
}

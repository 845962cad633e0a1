// One direction of the edge-aware blur; bilateral_blur.h has the weights.
//
// Defines: LAYER (whose surfaces), DIRECTION (ivec2), BLUR_RADIUS, STEP, WEIGHTS (of distance 0 to BLUR_RADIUS), KIND
// with the names of its values, and of the bilateral kind: MONOTONIC (0, 1), DEPTH_SHARPNESS (per metre),
// NORMAL_SHARPNESS, PLANE_SHARPNESS, PLANE_EXEMPTION (square metres, where there is one), STORED_KEYS (0: depths are
// compared as they are).

#include "depth_mip_chain.glsl"
#include "normal_encoding.glsl"

layout(binding = 0) uniform sampler2DArray noisy;
layout(binding = 1) uniform sampler2DArray depth;
layout(binding = 2) uniform sampler2DArray normal;
#if STORED_KEYS
layout(binding = 4) uniform sampler2DArray depth_keys;  // fractions of the far plane
#endif
uniform int noisy_layer;

layout(location = 0) out vec4 smoothed;

const float distance_weight[BLUR_RADIUS + 1] = float[](WEIGHTS);

#if KIND == BILATERAL
struct Surface {
    float depth, key;    // metres
    vec3 point, normal;  // camera space, world space
};

Surface surface_at(ivec2 pixel) {
    Surface surface;
    surface.depth = texelFetch(depth, ivec3(pixel, LAYER), 0).r;
#if STORED_KEYS
    surface.key = texelFetch(depth_keys, ivec3(pixel, LAYER), 0).r * far_plane;
#else
    surface.key = surface.depth;
#endif
    surface.point = surface_point(pixel, LAYER, surface.depth);
    surface.normal = normal_of_texel(texelFetch(normal, ivec3(pixel, LAYER), 0));
    return surface;
}

float edge_weight(Surface centre, Surface tap) {
    vec3 offset = tap.point - centre.point;
    vec3 direction = world_space_direction(offset * inversesqrt(max(dot(offset, offset), 1e-30)));
    float off_plane = max(abs(dot(direction, centre.normal)), abs(dot(direction, tap.normal)));
    float depth_weight = max(0.0, 1.0 - DEPTH_SHARPNESS * abs(tap.key - centre.key));
    float normal_weight = max(0.0, 1.0 - NORMAL_SHARPNESS * (1.0 - dot(centre.normal, tap.normal)));
    float plane_weight = max(0.0, 1.0 - 2.0 * PLANE_SHARPNESS * off_plane);
#ifdef PLANE_EXEMPTION
    if (dot(offset, offset) < PLANE_EXEMPTION) plane_weight = 1.0;
#endif
    return is_background(tap.depth) ? 0.0 : depth_weight * normal_weight * plane_weight * plane_weight;
}
#else
struct Surface {
    float depth;
};

Surface surface_at(ivec2 pixel) { return Surface(texelFetch(depth, ivec3(pixel, LAYER), 0).r); }

float edge_weight(Surface centre, Surface tap) {
    // Of values of a depth buffer, which would cancel.
    float difference = near_plane * far_plane / (far_plane - near_plane) * abs(1.0 / tap.depth - 1.0 / centre.depth);
#if KIND == GAUSSIAN_2015_LISTING
    difference = sqrt(difference);
#endif
    return is_background(tap.depth) ? 0.0 : max(0.0, 1.0 - difference);
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 value = texelFetch(noisy, ivec3(pixel, noisy_layer), 0);
    Surface centre = surface_at(pixel);
    smoothed = value;
    if (is_background(centre.depth)) return;

    // Sums of differences to the centre: a constant image comes out bit for bit.
    vec4 difference = vec4(0.0);
    float total = distance_weight[0];
    for (int side = -1; side <= 1; side += 2) {
        float smallest = 1.0;
        for (int i = 1; i <= BLUR_RADIUS; ++i) {
            ivec2 position = pixel + side * i * STEP * DIRECTION;
            ivec2 tap = clamp(position, ivec2(0), image_size - 1);
            float edge = is_inside(position) ? edge_weight(centre, surface_at(tap)) : 0.0;
#if KIND == BILATERAL && MONOTONIC
            smallest = min(smallest, edge);
            edge = smallest;
#endif
            float weight = distance_weight[i] * edge;
            total += weight;
            difference += weight * (texelFetch(noisy, ivec3(tap, noisy_layer), 0) - value);
        }
    }
    smoothed = value + difference / total;
}

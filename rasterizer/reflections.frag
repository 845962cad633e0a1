// The plane `reflection`; reflections.h has the formulas.
//
// Defines: ROUGHNESS with the names of its values, SAMPLES, BORDER_FADE (pixels), FALLBACK (0, 1: there is a cube),
// LAMPS (0, 1: there is a plane of highlights), RAYS_PER_DRAW, RADIUS (metres; none: unlimited),
// COARSEST_RADIANCE_LEVEL, and those of screen_space_ray.glsl, surface_radiance.glsl, falloff.glsl, specular_albedo.glsl.
#include "screen_space_ray.glsl"
#include "surface_radiance.glsl"
#include "ggx.glsl"
#include "specular_albedo.glsl"
#if ROUGHNESS == MIP
#include "radiance_mip_chain.glsl"
#endif
#ifdef RADIUS
#include "falloff.glsl"
#endif

layout(binding = 2) uniform sampler2DArray specular_plane;
layout(binding = 8) uniform sampler2DArray roughness_plane;
#if LAMPS
layout(binding = 9) uniform sampler2DArray lamp_highlights;
#endif
#if FALLBACK
#include "radiance_maps.glsl"
layout(binding = 10) uniform samplerCube fallback_radiance;
#endif

layout(location = 0) out vec3 reflection;

struct Lobe {
    vec3 f0;
    float f90, roughness, alpha;
    vec3 normal, to_viewer;  // camera space
    float cosine_o;
};

vec3 hit_radiance(RayHit hit, Lobe lobe) {
#if ROUGHNESS == MIP
    // Half of the microfacets have normals within atan(alpha) of the surface's; seen at an angle the lobe is narrower.
    float tangent = 2.0 * lobe.alpha / max(1.0 - lobe.alpha * lobe.alpha, 1e-3) * sqrt(lobe.cosine_o);
    float surface = texelFetch(depth, ivec3(hit.pixel, hit.layer), 0).r;
    float side = min(2.50662827 * tangent * hit.distance, 2.0 * hit.height) * pixels_per_metre / surface;
    vec4 mean = chain_radiance(hit.position, hit.layer, log2(max(side, 1.0)));
    return mean.a > 0.0 ? mean.rgb / mean.a : surface_radiance(hit.pixel, hit.layer);
#else
    return surface_radiance(hit.pixel, hit.layer);
#endif
}

// What arrives against `direction`.
vec3 arriving(ivec2 pixel, vec3 origin, vec3 camera_normal, vec3 direction, Lobe lobe) {
    RayHit hit = trace(pixel, origin, camera_normal, direction);
    vec3 radiance = vec3(0.0);
    float weight = 0.0;
    if (hit.found) {
#if BORDER_FADE > 0
        vec2 to_border = min(hit.position, view_size - hit.position);
        weight = clamp(min(to_border.x, to_border.y) / float(BORDER_FADE), 0.0, 1.0);
#else
        weight = 1.0;
#endif
        radiance = weight * hit_radiance(hit, lobe);
#ifdef RADIUS
        radiance *= falloff(hit.distance * hit.distance / (RADIUS * RADIUS));
#endif
    }
#if FALLBACK
#if ROUGHNESS == SAMPLED
    float roughness = 0.0;
#else
    float roughness = lobe.roughness;
#endif
    if (weight < 1.0) {
        radiance += (1.0 - weight) * glossy_radiance(fallback_radiance, world_space_direction(direction), roughness);
    }
#endif
    return radiance;
}

#if ROUGHNESS == SAMPLED
uniform int first_ray;  // of this draw; what draws after the first one give is added

uint hash(uint x) {
    x = (x ^ (x >> 16)) * 0x7FEB352Du;
    x = (x ^ (x >> 15)) * 0x846CA68Bu;
    return x ^ (x >> 16);
}

// Point i of the pixel's sequence in [0, 1)^2.
vec2 sample_point(int i, uvec2 start) {
    uvec2 point = start + uint(i) * uvec2(3242174889u, 2447445413u);
    return vec2(point >> 8) * 5.9604644775390625e-8;
}

// A normal of the microfacets that the viewer sees, in the frame of the lobe's normal (z) and the viewer (x, z).
vec3 visible_normal(vec2 u, vec3 to_viewer, float alpha) {
    vec3 view = normalize(vec3(alpha * to_viewer.xy, to_viewer.z));
    float azimuth = 6.28318530717959 * u.y;
    float height = (1.0 - u.x) * (1.0 + view.z);
    float across = sqrt(u.x * (1.0 + view.z) * (height + (1.0 - view.z)));
    vec2 cap = across * vec2(cos(azimuth), sin(azimuth)) + view.xy;
    return normalize(vec3(alpha * cap, height));
}

vec3 traced_lobe(ivec2 pixel, vec3 origin, vec3 camera_normal, Lobe lobe) {
    vec3 across = lobe.to_viewer - lobe.cosine_o * lobe.normal;
    vec3 any_axis = abs(lobe.normal.x) < 0.7 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    vec3 x = normalize(dot(across, across) > 1e-6 ? across : cross(lobe.normal, any_axis));
    vec3 y = cross(lobe.normal, x);
    vec3 local_viewer = vec3(dot(lobe.to_viewer, x), 0.0, lobe.cosine_o);
    float root_o = smith_root(lobe.cosine_o, lobe.alpha);
    uvec2 start;
    start.x = hash(uint(pixel.x + pattern_shift.x) + 65536u * uint(pixel.y + pattern_shift.y));
    start.y = hash(start.x + 0x9E3779B9u);
    vec3 sum = vec3(0.0);
    for (int i = first_ray; i < min(first_ray + RAYS_PER_DRAW, SAMPLES); ++i) {
        vec3 h = visible_normal(sample_point(i, start), local_viewer, lobe.alpha);
        float cosine_oh = dot(local_viewer, h);
        vec3 local = 2.0 * cosine_oh * h - local_viewer;
        float cosine_i = local.z;
        if (cosine_i <= 0.0) continue;
        float root_i = smith_root(cosine_i, lobe.alpha);
        // G2 / G1
        float passed = cosine_i * (lobe.cosine_o + root_o) / (lobe.cosine_o * root_i + cosine_i * root_o);
        vec3 direction = normalize(local.x * x + local.y * y + local.z * lobe.normal);
        sum += schlick_fresnel(lobe.f0, lobe.f90, cosine_oh) * passed *
               arriving(pixel, origin, camera_normal, direction, lobe);
    }
    return sum / float(SAMPLES);
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    reflection = vec3(0.0);
    float centre_depth = texelFetch(depth, ivec3(pixel, 0), 0).r;
    vec4 specular = texelFetch(specular_plane, ivec3(pixel, 0), 0);
    if (is_background(centre_depth) || specular == vec4(0.0)) return;
#if ROUGHNESS == SAMPLED
    bool first_draw = first_ray == 0;
#else
    const bool first_draw = true;
#endif
#if LAMPS
    if (first_draw) reflection = texelFetch(lamp_highlights, ivec3(pixel, 0), 0).rgb;
#endif
    vec3 camera_normal = camera_space_direction(normal_of_texel(texelFetch(normal, ivec3(pixel, 0), 0)));
    vec3 origin = surface_point(pixel, 0, centre_depth);
    Lobe lobe;
    lobe.f0 = specular.rgb;
    lobe.f90 = specular.a;
    lobe.roughness = texelFetch(roughness_plane, ivec3(pixel, 0), 0).r;
    lobe.alpha = ggx_alpha(lobe.roughness);
    lobe.to_viewer = normalize(-origin);
    lobe.normal = lobe_normal(camera_normal, lobe.to_viewer);
    lobe.cosine_o = max(dot(lobe.normal, lobe.to_viewer), 0.0);
#if ROUGHNESS == SAMPLED
    if (lobe.alpha > 0.0) {
        reflection += traced_lobe(pixel, origin, camera_normal, lobe);
        return;
    }
#endif
    if (!first_draw) return;
    vec3 direction = 2.0 * lobe.cosine_o * lobe.normal - lobe.to_viewer;
    vec2 share = specular_split(lobe.cosine_o, lobe.alpha);
    reflection += (share.x * lobe.f0 + share.y * lobe.f90) * arriving(pixel, origin, camera_normal, direction, lobe);
}

// What the specular lobe reflects of lamps and suns; lamp_highlights_pass.h has the formula.
//
// Defines: POINT_LIGHTS, SPOT_LIGHTS, DIRECTIONAL_LIGHTS (their numbers, where not zero), and those of
// shadow_lookup.glsl.
#include "ggx.glsl"
#include "lit_surface.glsl"
#include "local_light.glsl"
#ifdef DIRECTIONAL_LIGHTS
#include "directional_light.glsl"
#endif

layout(binding = 2) uniform sampler2DArray specular_plane;
layout(binding = 8) uniform sampler2DArray roughness_plane;

layout(location = 0) out vec3 highlights;

struct Lobe {
    vec3 f0;
    float f90, alpha;
    vec3 normal, to_viewer;
};

// Of light that arrives from the unit vector `to_light` with that irradiance on the surface of normal `shading_normal`.
vec3 reflected(Lobe lobe, vec3 to_light, vec3 irradiance, vec3 shading_normal) {
    float cosine_i = dot(lobe.normal, to_light);
    float cosine_shading = dot(shading_normal, to_light);
    vec3 sum = lobe.to_viewer + to_light;
    float square = dot(sum, sum);
    if (irradiance == vec3(0.0) || cosine_i <= 0.0 || cosine_shading <= 0.0 || square == 0.0) return vec3(0.0);
    vec3 h = sum * inversesqrt(square);
    vec3 across = cross(lobe.normal, h);
    float cosine_o = max(dot(lobe.normal, lobe.to_viewer), 0.0);
    float masking = cosine_o * smith_root(cosine_i, lobe.alpha) + cosine_i * smith_root(cosine_o, lobe.alpha);
    float visibility = 0.5 / masking;
    float distribution = ggx_distribution(dot(lobe.normal, h), dot(across, across), lobe.alpha);
    return schlick_fresnel(lobe.f0, lobe.f90, dot(lobe.to_viewer, h)) * (distribution * visibility) *
           (irradiance * (cosine_i / cosine_shading));
}

void main() {
    highlights = vec3(0.0);
    vec3 receiver, normal;
    if (!find_surface(receiver, normal)) return;
    ivec3 texel = ivec3(gl_FragCoord.xy, 0);
    vec4 specular = texelFetch(specular_plane, texel, 0);
    Lobe lobe;
    lobe.f0 = specular.rgb;
    lobe.f90 = specular.a;
    lobe.alpha = ggx_alpha(texelFetch(roughness_plane, texel, 0).r);
    // No mirror image of a lamp without extent has any.
    if (specular == vec4(0.0) || lobe.alpha == 0.0) return;
    lobe.to_viewer = normalize(world_from_camera[3].xyz - receiver);
    lobe.normal = lobe_normal(normal, lobe.to_viewer);
#ifdef POINT_LIGHTS
    for (int i = 0; i < POINT_LIGHTS; ++i) {
        vec3 to_light = normalize(point_lights[i].position - receiver);
        highlights += reflected(lobe, to_light, point_irradiance(point_lights[i], receiver, normal), normal);
    }
#endif
#ifdef SPOT_LIGHTS
    for (int i = 0; i < SPOT_LIGHTS; ++i) {
        vec3 to_light = normalize(spot_lights[i].position - receiver);
        highlights += reflected(lobe, to_light, spot_irradiance(spot_lights[i], receiver, normal), normal);
    }
#endif
#ifdef DIRECTIONAL_LIGHTS
    for (int i = 0; i < DIRECTIONAL_LIGHTS; ++i) {
        vec3 irradiance = directional_irradiance(directional_lights[i], receiver, normal);
        highlights += reflected(lobe, -directional_lights[i].direction, irradiance, normal);
    }
#endif
}

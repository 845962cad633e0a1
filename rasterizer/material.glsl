// The material at a point: the counterpart of Scene::surface and Scene::is_opaque. Level 0, bilinear.
//
// Defines: BASE_COLOUR_TEXTURE, METALLIC_ROUGHNESS_TEXTURE, EMISSION, EMISSION_TEXTURE, ALPHA_MASK, ALPHA_TEXTURE.

#include "scene.glsl"

layout(binding = 0) uniform sampler2D base_colour_texture;
layout(binding = 1) uniform sampler2D metallic_roughness_texture;
layout(binding = 2) uniform sampler2D emission_texture;
layout(binding = 3) uniform sampler2D alpha_texture;

#ifdef ALPHA_MASK
bool is_opaque(vec2 uv) {
#ifdef ALPHA_TEXTURE
    return textureLod(alpha_texture, uv, 0.0)[alpha_channel] >= alpha_cutoff;
#else
    return textureLod(base_colour_texture, uv, 0.0).a >= alpha_cutoff;
#endif
}
#endif

// The specular lobe; f0 and f90 0: there is none.
struct SpecularSurface {
    vec3 f0;
    float f90, roughness;
};

SpecularSurface surface_specular(vec2 uv) {
    vec3 base_colour = base_colour_and_metallic.rgb;
    float metallic = base_colour_and_metallic.a;
    SpecularSurface surface;
    surface.roughness = emission_and_roughness.a;
#ifdef BASE_COLOUR_TEXTURE
    base_colour *= textureLod(base_colour_texture, uv, 0.0).rgb;
#endif
#ifdef METALLIC_ROUGHNESS_TEXTURE
    vec4 texel = textureLod(metallic_roughness_texture, uv, 0.0);
    surface.roughness *= texel.g;
    metallic *= texel.b;
#endif
    surface.f0 = mix(vec3(dielectric_reflectance), base_colour, metallic);
    surface.f90 = mix(dielectric_reflectance > 0.0 ? 1.0 : 0.0, 1.0, metallic);
    return surface;
}

// Diffuse reflectance: what is not metal.
vec3 surface_albedo(vec2 uv) {
    vec3 base_colour = base_colour_and_metallic.rgb;
    float metallic = base_colour_and_metallic.a;
#ifdef BASE_COLOUR_TEXTURE
    base_colour *= textureLod(base_colour_texture, uv, 0.0).rgb;
#endif
#ifdef METALLIC_ROUGHNESS_TEXTURE
    metallic *= textureLod(metallic_roughness_texture, uv, 0.0).b;
#endif
    return base_colour * (1.0 - metallic);
}

vec3 surface_emission(vec2 uv) {
#ifdef EMISSION_TEXTURE
    return emission_and_roughness.rgb * textureLod(emission_texture, uv, 0.0).rgb;
#else
    return emission_and_roughness.rgb;
#endif
}

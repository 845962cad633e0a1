// Irradiance from one directional light, shadowed. Define: DIRECTIONAL_LIGHTS: their number; and those of
// shadow_lookup.glsl.
#include "shadow_lookup.glsl"

struct DirectionalLight {
    vec3 direction;
    int map;
    vec3 irradiance;
    float texel_size;
    mat4 clip_from_world;
    vec4 right, up;
};
layout(std430, binding = 2) readonly buffer DirectionalBlock { DirectionalLight directional_lights[]; };

vec3 directional_irradiance(DirectionalLight light, vec3 receiver, vec3 normal) {
    float cosine = -dot(normal, light.direction);
    if (cosine <= 0.0) return vec3(0.0);
    float slope = abs(dot(normal, light.right.xyz)) + abs(dot(normal, light.up.xyz));
    vec3 raised = lifted(receiver, normal, map_reach * light.texel_size, slope);
    return light.irradiance * (cosine * map_visibility(light.map, light.clip_from_world, raised));
}

// Irradiance from one point or spot light, shadowed.
//
// Defines: POINT_LIGHTS, SPOT_LIGHTS: their numbers, where not zero; and those of shadow_lookup.glsl.
#include "shadow_lookup.glsl"

#if defined(POINT_LIGHTS) || defined(SPOT_LIGHTS)
// constant + linear d + quadratic d^2; exactly `square`, the squared distance, for the terms 0, 0, 1.
float attenuation_divisor(vec4 terms, float square) {
    return terms.x + terms.y * sqrt(square) + terms.z * square;
}
#endif

#ifdef POINT_LIGHTS
struct PointLight {
    vec3 position;
    float depth_scale;
    vec3 intensity;
    int cube;
    vec4 attenuation;
};
layout(std430, binding = 0) readonly buffer PointBlock { PointLight point_lights[]; };

vec3 point_irradiance(PointLight light, vec3 receiver, vec3 normal) {
    vec3 to_light = light.position - receiver;
    float square = dot(to_light, to_light);
    float cosine = dot(normal, to_light) * inversesqrt(square);
    if (cosine <= 0.0) return vec3(0.0);
    return light.intensity * (cosine / attenuation_divisor(light.attenuation, square)) *
           point_visibility(light.cube, light.depth_scale, -to_light, normal);
}
#endif

#ifdef SPOT_LIGHTS
struct SpotLight {
    vec3 position;
    int map;
    vec3 direction;
    float cosine_outer;
    vec3 intensity;
    float cosine_inner;
    mat4 clip_from_world;
    float texel_size;
    float depth_scale;
    int cube;
    float padding;
    vec4 attenuation;
};
layout(std430, binding = 1) readonly buffer SpotBlock { SpotLight spot_lights[]; };

float spot_visibility(SpotLight light, vec3 receiver, vec3 normal) {
    vec3 from_light = receiver - light.position;
#ifdef SHADOW_MAPS
    if (light.map >= 0) {
        float texel_size = map_reach * light.texel_size * dot(from_light, light.direction);
        return map_visibility(light.map, light.clip_from_world,
                              lifted(receiver, normal, texel_size, largest_slope(normal, light.direction)));
    }
#endif
    return point_visibility(light.cube, light.depth_scale, from_light, normal);
}

vec3 spot_irradiance(SpotLight light, vec3 receiver, vec3 normal) {
    vec3 to_light = light.position - receiver;
    float square = dot(to_light, to_light);
    vec3 direction = to_light * inversesqrt(square);
    float cosine = dot(normal, direction);
    float from_axis = -dot(direction, light.direction);
    if (cosine <= 0.0 || from_axis <= light.cosine_outer) return vec3(0.0);
    float cone = clamp((from_axis - light.cosine_outer) / (light.cosine_inner - light.cosine_outer), 0.0, 1.0);
    return light.intensity * (cone * cone * cosine / attenuation_divisor(light.attenuation, square) *
                              spot_visibility(light, receiver, normal));
}
#endif

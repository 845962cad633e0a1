// Light that reaches each pixel of one layer straight from a light, reflected by its Lambertian part.
//
// Defines: POINT_LIGHTS, SPOT_LIGHTS, DIRECTIONAL_LIGHTS, EMITTERS (their numbers, where not zero), ENVIRONMENT,
// AMBIENT_VISIBILITY, and the sizes of the shadow maps.
#include "view.glsl"
#include "normal_encoding.glsl"
#include "polygon_light.glsl"

layout(binding = 0) uniform sampler2DArray depth_plane;
layout(binding = 1) uniform sampler2DArray normal_plane;
layout(binding = 2) uniform sampler2DArray albedo_plane;
uniform int layer;
uniform float bias;  // metres

layout(location = 0) out vec3 direct;

const float pi = 3.14159265358979;

// Texels of a shadow map are flat steps across the receiver, and a filtered lookup reaches up to one texel away along each
// axis of the map. Lifting the receiver along its normal by (texel size) * (|n_x| + |n_y|), n_x and n_y the normal in the
// map's plane, makes it clear the steps of its own surface to first order, and no more than that.
vec3 lifted(vec3 receiver, vec3 normal, float texel_size, float slope) {
    return receiver + normal * (bias + texel_size * slope);
}

#if defined(POINT_CUBES) || defined(EMITTERS)
// `from_light` leads from the light to the receiver. Depth in the map is near / (distance along the face's axis).
float cube_visibility(samplerCubeArrayShadow maps, float size, int cube, float near, vec3 from_light, vec3 normal) {
    vec3 distance = abs(from_light);
    float along_axis = max(distance.x, max(distance.y, distance.z));
    vec3 n = abs(normal);
    float n_axis = distance.x == along_axis ? n.x : distance.y == along_axis ? n.y : n.z;
    vec3 p = lifted(from_light, normal, 2.0 * along_axis / size, n.x + n.y + n.z - n_axis);
    distance = abs(p);
    along_axis = max(distance.x, max(distance.y, distance.z));
    return texture(maps, vec4(p, float(cube)), near / along_axis);
}
#endif

#ifdef POINT_CUBES
layout(binding = 3) uniform samplerCubeArrayShadow point_cubes;
#endif

#ifdef SHADOW_MAPS
layout(binding = 4) uniform sampler2DArrayShadow shadow_maps;

float map_visibility(int map, mat4 clip_from_world, vec3 receiver) {
    vec4 clip = clip_from_world * vec4(receiver, 1.0);
    vec3 ndc = clip.xyz / clip.w;
    return texture(shadow_maps, vec4(0.5 * ndc.xy + 0.5, float(map), ndc.z));
}
#endif

#if defined(POINT_LIGHTS) || defined(SPOT_LIGHTS)
// constant + linear d + quadratic d^2; exactly `square`, the squared distance, for the terms 0, 0, 1.
float attenuation_divisor(vec4 terms, float square) {
    return terms.x + terms.y * sqrt(square) + terms.z * square;
}
#endif

#ifdef POINT_LIGHTS
struct PointLight {
    vec3 position;
    float near;
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
           cube_visibility(point_cubes, POINT_CUBES, light.cube, light.near, -to_light, normal);
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
    float near;
    int cube;
    float padding;
    vec4 attenuation;
};
layout(std430, binding = 1) readonly buffer SpotBlock { SpotLight spot_lights[]; };

float spot_visibility(SpotLight light, vec3 receiver, vec3 normal) {
#ifdef POINT_CUBES
    if (light.map < 0) {
        return cube_visibility(point_cubes, POINT_CUBES, light.cube, light.near, receiver - light.position, normal);
    }
#endif
#ifdef SHADOW_MAPS
    float along_axis = dot(receiver - light.position, light.direction);
    float n_axis = dot(normal, light.direction);
    // |n_x| + |n_y| is at most sqrt(2) times the part across the axis.
    float slope = 1.41421356 * sqrt(max(0.0, 1.0 - n_axis * n_axis));
    return map_visibility(light.map, light.clip_from_world, lifted(receiver, normal, light.texel_size * along_axis, slope));
#else
    return 1.0;
#endif
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

#ifdef DIRECTIONAL_LIGHTS
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
    return light.irradiance *
           (cosine * map_visibility(light.map, light.clip_from_world, lifted(receiver, normal, light.texel_size, slope)));
}
#endif

#ifdef EMITTERS
layout(binding = 5) uniform samplerCubeArrayShadow emitter_cubes;

struct Emitter {
    int first_piece, pieces;
    int first_cube, cubes;
    int discs, both_sides;
    int padding[2];
};
struct Piece {
    vec4 a, b, c;  // w: red, green, blue radiance
};
layout(std430, binding = 3) readonly buffer EmitterBlock { Emitter emitters[]; };
layout(std430, binding = 4) readonly buffer PieceBlock { Piece pieces[]; };
layout(std430, binding = 5) readonly buffer EmitterCubeBlock { vec4 emitter_cube_positions[]; };  // w: near plane

vec3 emitter_irradiance(Emitter emitter, vec3 receiver, vec3 normal) {
    bool both_sides = emitter.both_sides != 0;
    vec3 sum = vec3(0.0);
    for (int i = emitter.first_piece; i < emitter.first_piece + emitter.pieces; ++i) {
        Piece piece = pieces[i];
        vec3 a = piece.a.xyz - receiver, b = piece.b.xyz - receiver, c = piece.c.xyz - receiver;
        float irradiance = 0.0;
        if (emitter.discs != 0) {
            irradiance = disc_irradiance(a, piece.b.xyz, normal, both_sides);
        } else {
            // Height of the receiver over the triangle's front. A ten-thousandth of its size: the triangle itself, or one
            // beside it in the same plane, which float positions would see from either side at random.
            vec3 front = cross(b - a, c - a);
            float height = -dot(front, a);
            if (both_sides) height = abs(height);
            if (height * height > 1e-8 * dot(front, front) * length(front)) {
                irradiance = height > 0.0 ? triangle_irradiance(a, b, c, normal) : 0.0;
            }
        }
        sum += irradiance * vec3(piece.a.w, piece.b.w, piece.c.w);
    }
    if (sum == vec3(0.0)) return sum;
    float visibility = 0.0;
    for (int i = emitter.first_cube; i < emitter.first_cube + emitter.cubes; ++i) {
        vec4 cube = emitter_cube_positions[i];
        visibility += cube_visibility(emitter_cubes, EMITTER_CUBE_SIZE, i, cube.w, receiver - cube.xyz, normal);
    }
    return sum * (visibility / float(emitter.cubes));
}
#endif

#ifdef ENVIRONMENT
uniform vec3 environment_irradiance[9];  // irradiance_from() in environment_light.cpp
#ifdef AMBIENT_VISIBILITY
layout(binding = 6) uniform sampler2DArray ambient_visibility;
#endif

vec3 irradiance_from_environment(vec3 n) {
    vec3 sum = environment_irradiance[0] * 0.282095;
#if ENVIRONMENT > 1
    sum += environment_irradiance[1] * (0.488603 * n.y) + environment_irradiance[2] * (0.488603 * n.z) +
           environment_irradiance[3] * (0.488603 * n.x) + environment_irradiance[4] * (1.092548 * n.x * n.y) +
           environment_irradiance[5] * (1.092548 * n.y * n.z) +
           environment_irradiance[6] * (0.315392 * (3.0 * n.z * n.z - 1.0)) +
           environment_irradiance[7] * (1.092548 * n.x * n.z) +
           environment_irradiance[8] * (0.546274 * (n.x * n.x - n.y * n.y));
#endif
    return max(sum, vec3(0.0));
}
#endif

void main() {
    ivec3 texel = ivec3(gl_FragCoord.xy, layer);
    float depth = texelFetch(depth_plane, texel, 0).r;
    direct = vec3(0.0);
    if (is_background(depth)) return;
    vec3 receiver = world_space_point(gl_FragCoord.xy, depth);
    vec3 normal = decode_normal(texelFetch(normal_plane, texel, 0).rg);
    vec3 irradiance = vec3(0.0);
#ifdef POINT_LIGHTS
    for (int i = 0; i < POINT_LIGHTS; ++i) irradiance += point_irradiance(point_lights[i], receiver, normal);
#endif
#ifdef SPOT_LIGHTS
    for (int i = 0; i < SPOT_LIGHTS; ++i) irradiance += spot_irradiance(spot_lights[i], receiver, normal);
#endif
#ifdef DIRECTIONAL_LIGHTS
    for (int i = 0; i < DIRECTIONAL_LIGHTS; ++i) {
        irradiance += directional_irradiance(directional_lights[i], receiver, normal);
    }
#endif
#ifdef EMITTERS
    for (int i = 0; i < EMITTERS; ++i) irradiance += emitter_irradiance(emitters[i], receiver, normal);
#endif
#ifdef ENVIRONMENT
    vec3 ambient = irradiance_from_environment(normal);
#ifdef AMBIENT_VISIBILITY
    ambient *= texelFetch(ambient_visibility, ivec3(texel.xy, 0), 0).r;
#endif
    irradiance += ambient;
#endif
    direct = texelFetch(albedo_plane, texel, 0).rgb / pi * irradiance;
}

// Light that reaches each pixel of one layer straight from a light, reflected by its Lambertian part.
//
// Defines: POINT_LIGHTS, SPOT_LIGHTS, DIRECTIONAL_LIGHTS, EMITTERS (their numbers, where not zero), ENVIRONMENT,
// ENVIRONMENT_CUBE, AMBIENT_VISIBILITY, LOCAL_IRRADIANCE (a plane holds the light of point and spot lights), and those of shadow_lookup.glsl.
#include "lit_surface.glsl"
#include "local_light.glsl"
#include "polygon_light.glsl"

layout(binding = 2) uniform sampler2DArray albedo_plane;

layout(location = 0) out vec3 direct;

const float pi = 3.14159265358979;

#ifdef DIRECTIONAL_LIGHTS
#include "directional_light.glsl"
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
layout(std430, binding = 5) readonly buffer EmitterCubeBlock { vec4 emitter_cube_positions[]; };  // w: depth_scale

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
        visibility += cube_visibility(emitter_cubes, EMITTER_CUBES, i, cube.w, receiver - cube.xyz, normal);
    }
    return sum * (visibility / float(emitter.cubes));
}
#endif

#ifdef LOCAL_IRRADIANCE
layout(binding = 8) uniform sampler2DArray local_irradiance;
#endif

#ifdef ENVIRONMENT
#ifdef AMBIENT_VISIBILITY
layout(binding = 6) uniform sampler2DArray ambient_visibility;
#endif
#ifdef ENVIRONMENT_CUBE
#include "radiance_maps.glsl"
layout(binding = 9) uniform samplerCube environment_cube;

vec3 irradiance_from_environment(vec3 n) { return diffuse_irradiance(environment_cube, n); }
#else
uniform vec3 environment_irradiance[ENVIRONMENT];  // irradiance_from() in environment_light.cpp

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
#endif

void main() {
    direct = vec3(0.0);
    vec3 receiver, normal;
    if (!find_surface(receiver, normal)) return;
    ivec3 texel = ivec3(gl_FragCoord.xy, layer);
    vec3 irradiance = vec3(0.0);
#ifdef LOCAL_IRRADIANCE
    irradiance += texelFetch(local_irradiance, texel, 0).rgb;
#endif
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

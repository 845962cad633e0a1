// How much of a light reaches a receiver, from the shadow maps of shadow_pass.h.
//
// Defines: SHADOW_BIAS (metres); POINT_CUBES, POINT_PARABOLOIDS, SHADOW_MAPS, EMITTER_CUBES: texels per side of those that there are;
// LINEAR_CUBES where cubes keep distances; PCF_RADIUS (texels).

// Texels of a shadow map are flat steps across the receiver, and a filtered lookup reaches up to one texel away along each
// axis of the map. Lifting the receiver along its normal by (texel size) * (|n_x| + |n_y|), n_x and n_y the normal in the
// map's plane, makes it clear the steps of its own surface to first order, and no more than that.
vec3 lifted(vec3 receiver, vec3 normal, float texel_size, float slope) {
    return receiver + normal * (SHADOW_BIAS + texel_size * slope);
}

// |n_x| + |n_y| at most: sqrt(2) times the part of the normal across the axis.
float largest_slope(vec3 normal, vec3 axis) {
    float n_axis = dot(normal, axis);
    return 1.41421356 * sqrt(max(0.0, 1.0 - n_axis * n_axis));
}

#if defined(POINT_CUBES) || defined(EMITTER_CUBES)
// `from_light` leads from the light to the receiver. Depth in the map is depth_scale / (distance along the face's axis),
// or 1 - distance / depth_scale.
float cube_visibility(samplerCubeArrayShadow maps, float size, int cube, float depth_scale, vec3 from_light, vec3 normal) {
    vec3 distance = abs(from_light);
    float along_axis = max(distance.x, max(distance.y, distance.z));
    vec3 n = abs(normal);
    float n_axis = distance.x == along_axis ? n.x : distance.y == along_axis ? n.y : n.z;
    float slope = n.x + n.y + n.z - n_axis;
#ifdef LINEAR_CUBES
    // From texel to texel the distance to a point of the surface grows as its direction leaves the face's axis, too.
    float across = distance.x + distance.y + distance.z - along_axis;
    slope += abs(dot(normal, from_light)) * across / dot(from_light, from_light);
#endif
    vec3 p = lifted(from_light, normal, 2.0 * along_axis / size, slope);
#ifdef LINEAR_CUBES
    return texture(maps, vec4(p, float(cube)), 1.0 - length(p) / depth_scale);
#else
    distance = abs(p);
    along_axis = max(distance.x, max(distance.y, distance.z));
    return texture(maps, vec4(p, float(cube)), depth_scale / along_axis);
#endif
}
#endif

#ifdef POINT_PARABOLOIDS
layout(binding = 7) uniform sampler2DArrayShadow point_paraboloids;

// Depth in the map is 1 - distance / range.
float paraboloid_visibility(int pair, float range, vec3 from_light, vec3 normal) {
    const float disc_scale = 1.0 - 4.0 / POINT_PARABOLOIDS;
    float distance = length(from_light);
    vec3 direction = from_light / distance;
    // The map is conformal; a texel covers 2 / (size disc_scale) (1 + cosine) radians, cosine to the half's axis.
    float texel_angle = 2.0 / (POINT_PARABOLOIDS * disc_scale) * (1.0 + abs(direction.z));
    vec3 p = lifted(from_light, normal, texel_angle * distance, largest_slope(normal, direction));
    distance = length(p);
    direction = p / distance;
    vec2 disc = direction.xy / (1.0 + abs(direction.z));
    float layer = float(2 * pair + (direction.z < 0.0 ? 1 : 0));
    return texture(point_paraboloids, vec4(0.5 + 0.5 * disc_scale * disc, layer, 1.0 - distance / range));
}
#endif

#ifdef POINT_CUBES
layout(binding = 3) uniform samplerCubeArrayShadow point_cubes;
#endif

#if defined(POINT_LIGHTS) || defined(SPOT_LIGHTS)
// Of the cube or the pair of paraboloids `number`; -1: nothing is in the way.
float point_visibility(int number, float depth_scale, vec3 from_light, vec3 normal) {
    if (number < 0) return 1.0;
#ifdef POINT_CUBES
    return cube_visibility(point_cubes, POINT_CUBES, number, depth_scale, from_light, normal);
#elif defined(POINT_PARABOLOIDS)
    return paraboloid_visibility(number, depth_scale, from_light, normal);
#else
    return 1.0;
#endif
}
#endif

#ifdef SHADOW_MAPS
layout(binding = 4) uniform sampler2DArrayShadow shadow_maps;

// Percentage-closer filtering.
//   Source: Reeves, Salesin, Cook 1987, "Rendering Antialiased Shadows with Depth Maps"; here over a fixed square of
//   texels, each compared bilinearly.
float map_visibility(int map, mat4 clip_from_world, vec3 receiver) {
    vec4 clip = clip_from_world * vec4(receiver, 1.0);
    vec3 ndc = clip.xyz / clip.w;
    vec2 uv = 0.5 * ndc.xy + 0.5;
#if PCF_RADIUS > 0
    float sum = 0.0;
    for (int y = -PCF_RADIUS; y <= PCF_RADIUS; ++y) {
        for (int x = -PCF_RADIUS; x <= PCF_RADIUS; ++x) {
            sum += texture(shadow_maps, vec4(uv + vec2(x, y) / SHADOW_MAPS, float(map), ndc.z));
        }
    }
    return sum / float((2 * PCF_RADIUS + 1) * (2 * PCF_RADIUS + 1));
#else
    return texture(shadow_maps, vec4(uv, float(map), ndc.z));
#endif
}

// Texels that a lookup reaches to each side.
const float map_reach = float(PCF_RADIUS + 1);
#endif

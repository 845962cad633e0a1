// One layer of the G-buffer, or all at once; gbuffer_planes.h says what the planes hold.
//
// Defines: COMPARISON_LAYER (of the depth behind which fragments are kept), LAYERS_AT_ONCE (then only those of layer 1
// are compared, and layer 2 is the depth of the frame to come), REPROJECT (compares in the previous frame), WRITE_NORMAL,
// WRITE_ALBEDO, WRITE_DIFFUSE_ALBEDO, WRITE_SPECULAR, WRITE_ROUGHNESS, WRITE_EMISSION, WRITE_MOVING_INSTANCE and
// WRITE_POSITION with the location of each output, MOVING (some instances of the scene move), those of material.glsl,
// of gbuffer_vertex.glsl and, with WRITE_DIFFUSE_ALBEDO, of specular_albedo.glsl.
#include "gbuffer_vertex.glsl"
#include "material.glsl"
#include "normal_encoding.glsl"
#include "view.glsl"

#if defined(MOVING) && defined(REPROJECT)
#include "instance_motion.glsl"
#endif
#ifdef WRITE_DIFFUSE_ALBEDO
#include "ggx.glsl"
#include "specular_albedo.glsl"
#endif

in SurfaceVertex { SURFACE_VERTEX_MEMBERS } vertex;

layout(location = 0) out float depth;
#ifdef WRITE_NORMAL
layout(location = WRITE_NORMAL) out vec4 normal;
#endif
#ifdef WRITE_ALBEDO
layout(location = WRITE_ALBEDO) out vec3 albedo;
#endif
#ifdef WRITE_DIFFUSE_ALBEDO
layout(location = WRITE_DIFFUSE_ALBEDO) out vec3 diffuse_albedo;
#endif
#ifdef WRITE_SPECULAR
layout(location = WRITE_SPECULAR) out vec4 specular;
#endif
#ifdef WRITE_ROUGHNESS
layout(location = WRITE_ROUGHNESS) out float roughness;
#endif
#ifdef WRITE_EMISSION
layout(location = WRITE_EMISSION) out vec3 emission;
#endif
#ifdef WRITE_MOVING_INSTANCE
layout(location = WRITE_MOVING_INSTANCE) out uint moving_instance;
#endif
#ifdef WRITE_POSITION
layout(location = WRITE_POSITION) out vec3 camera_position;
#endif

#ifdef COMPARISON_LAYER
layout(binding = 4) uniform sampler2DArray comparison;
uniform float minimum_separation;  // metres

// Also false where the comparison is empty (+infinity).
bool lies_behind(float fragment_depth, ivec2 pixel) {
    return fragment_depth > texelFetch(comparison, ivec3(pixel, COMPARISON_LAYER), 0).r + minimum_separation;
}

#ifdef REPROJECT
uniform bool follow_motion;  // else the comparison is of this frame

bool lay_behind() {
    vec3 point = camera_space_point(gl_FragCoord.xy, depth);
#ifdef MOVING
    point += displacement_of(moving_number, point);
#endif
    vec3 previous = (previous_camera_from_camera * vec4(point, 1.0)).xyz;
    float previous_depth = -previous.z;
    vec2 pixel = previous_pixel_of(previous);
    bool seen = previous_depth > 0.0 && all(greaterThanEqual(pixel, vec2(0.0))) && all(lessThan(pixel, view_size));
    return seen && lies_behind(previous_depth, ivec2(pixel));
}
#endif
#endif

#ifdef WRITE_DIFFUSE_ALBEDO
// What the specular lobe leaves of light that comes from the viewer: the diffuse lobe is scaled by it.
vec3 left_by_specular(SpecularSurface surface, vec3 n) {
    if (surface.f90 == 0.0 && surface.f0 == vec3(0.0)) return vec3(1.0);
    vec3 to_viewer = -normalize(camera_space_point(gl_FragCoord.xy, depth));
    float cosine = max(dot(lobe_normal(camera_space_direction(n), to_viewer), to_viewer), 0.0);
    vec2 share = specular_split(cosine, ggx_alpha(surface.roughness));
    return 1.0 - (share.x * surface.f0 + share.y * surface.f90);
}
#endif

bool is_kept() {
#if !defined(COMPARISON_LAYER)
    return true;
#else
#ifdef LAYERS_AT_ONCE
    if (gl_Layer != 1) return true;
#endif
#ifdef REPROJECT
    if (follow_motion) return lay_behind();
#endif
    return lies_behind(depth, ivec2(gl_FragCoord.xy));
#endif
}

void main() {
    // w_clip is the distance along the camera's -Z; its inverse is linear on the screen.
    depth = 1.0 / gl_FragCoord.w;
    if (!is_kept()) discard;
#ifdef TEXTURE_COORDINATES
    vec2 uv = vertex.uv;
#else
    const vec2 uv = vec2(0.0);
#endif
#ifdef ALPHA_MASK
    if (!is_opaque(uv)) discard;
#endif
    bool dark = two_sided == 0 && !gl_FrontFacing;
#if defined(WRITE_NORMAL) || defined(WRITE_DIFFUSE_ALBEDO)
    vec3 n = normalize(vertex.world_normal);
    n = gl_FrontFacing ? n : -n;
#endif
#ifdef WRITE_NORMAL
    normal = texel_of_normal(n);
#endif
#ifdef WRITE_ALBEDO
    albedo = dark ? vec3(0.0) : surface_albedo(uv);
#endif
#if defined(WRITE_DIFFUSE_ALBEDO) || defined(WRITE_SPECULAR) || defined(WRITE_ROUGHNESS)
    SpecularSurface surface = surface_specular(uv);
#endif
#ifdef WRITE_DIFFUSE_ALBEDO
    diffuse_albedo = dark ? vec3(0.0) : surface_albedo(uv) * left_by_specular(surface, n);
#endif
#ifdef WRITE_SPECULAR
    specular = dark ? vec4(0.0) : vec4(surface.f0, surface.f90);
#endif
#ifdef WRITE_ROUGHNESS
    roughness = surface.roughness;
#endif
#ifdef WRITE_EMISSION
#ifdef EMISSION
    emission = dark ? vec3(0.0) : surface_emission(uv);
#else
    emission = vec3(0.0);
#endif
#endif
#ifdef WRITE_MOVING_INSTANCE
    moving_instance = moving_number;
#endif
#ifdef WRITE_POSITION
    camera_position = camera_space_point(gl_FragCoord.xy, depth);
#endif
}

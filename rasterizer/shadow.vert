// Triangles of one instance, seen from a light; or in world space, for a later stage that projects them.
//
// Defines: PROJECTED_LATER (a geometry or tessellation stage follows), CLIP_PLANE (keep only what lies before
// front_plane), LINEAR_DISTANCE, TEXTURE_COORDINATES.
#include "scene.glsl"

layout(location = 0) in vec3 position;
layout(location = 2) in vec2 texture_coordinates;

#ifdef PROJECTED_LATER
#ifdef TEXTURE_COORDINATES
out vec2 vertex_uv;
#endif

void main() {
    gl_Position = world_from_object * vec4(position, 1.0);
#ifdef TEXTURE_COORDINATES
    vertex_uv = texture_coordinates;
#endif
}
#else
uniform mat4 clip_from_world;
#ifdef CLIP_PLANE
uniform vec4 front_plane;
out float gl_ClipDistance[1];
#endif
#ifdef LINEAR_DISTANCE
uniform vec3 light_position;
out vec3 from_light;
#endif
#ifdef TEXTURE_COORDINATES
out vec2 uv;
#endif

void main() {
    vec4 world = world_from_object * vec4(position, 1.0);
    gl_Position = clip_from_world * world;
#ifdef CLIP_PLANE
    gl_ClipDistance[0] = dot(front_plane, world);
#endif
#ifdef LINEAR_DISTANCE
    from_light = world.xyz - light_position;
#endif
#ifdef TEXTURE_COORDINATES
    uv = texture_coordinates;
#endif
}
#endif

// Triangles of one instance, seen from a light.
//
// Defines: CLIP_PLANE (keep only what lies before front_plane), TEXTURE_COORDINATES.
#include "scene.glsl"

layout(location = 0) in vec3 position;
layout(location = 2) in vec2 texture_coordinates;

uniform mat4 clip_from_world;
#ifdef CLIP_PLANE
uniform vec4 front_plane;
out float gl_ClipDistance[1];
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
#ifdef TEXTURE_COORDINATES
    uv = texture_coordinates;
#endif
}

// Triangles of one instance, for the G-buffer.
//
// Defines: LAYERS_AT_ONCE (2, or 3 where the last is the depth of the frame to come), LAYER_OF_INSTANCE (layers are
// selected here), STANDARD_DEPTH, and those of gbuffer_vertex.glsl.
#ifdef LAYER_OF_INSTANCE
#extension GL_ARB_shader_viewport_layer_array : require
#endif
#include "gbuffer_vertex.glsl"
#include "scene.glsl"
#include "view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texture_coordinates;

out SurfaceVertex { SURFACE_VERTEX_MEMBERS } vertex;
#if defined(LAYERS_AT_ONCE) && LAYERS_AT_ONCE == 3 && !defined(LAYER_OF_INSTANCE)
out vec4 next_position;  // in the frame to come
#endif

// Through camera space, where coordinates of what is seen closely are small: more exact than one product matrix.
vec4 seen_by(mat4 clip_from_camera, mat4 camera_from_world, mat4 world_from_object) {
    vec4 clip = clip_from_camera * (camera_from_world * (world_from_object * vec4(position, 1.0)));
#ifdef STANDARD_DEPTH
    clip.z = clip.w - clip.z;
#endif
    return clip;
}

void main() {
    gl_Position = seen_by(clip_from_camera, camera_from_world, world_from_object);
#if defined(LAYERS_AT_ONCE) && LAYERS_AT_ONCE == 3
    vec4 next = seen_by(next_clip_from_camera, next_camera_from_world, next_world_from_object);
#ifndef LAYER_OF_INSTANCE
    next_position = next;
#endif
#endif
#ifdef LAYER_OF_INSTANCE
    gl_Layer = gl_InstanceID;
#if LAYERS_AT_ONCE == 3
    if (gl_InstanceID == 2) gl_Position = next;
#endif
#endif
    vertex.world_normal = normalize(world_normal_from_object * normal);
#ifdef TEXTURE_COORDINATES
    vertex.uv = texture_coordinates;
#endif
}

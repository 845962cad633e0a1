// Triangles of one instance, for the G-buffer.
//
// Defines: TEXTURE_COORDINATES, DISPLACEMENT.
#include "scene.glsl"
#include "view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texture_coordinates;

out vec3 world_normal;
#ifdef TEXTURE_COORDINATES
out vec2 uv;
#endif
#ifdef DISPLACEMENT
out vec3 displacement_to_previous;
#endif

void main() {
    // Through camera space, where coordinates of what is seen closely are small: more exact than one product matrix.
    vec4 world = world_from_object * vec4(position, 1.0);
    gl_Position = clip_from_camera * (camera_from_world * world);
    world_normal = normalize(world_normal_from_object * normal);
#ifdef TEXTURE_COORDINATES
    uv = texture_coordinates;
#endif
#ifdef DISPLACEMENT
    mat4 moved = previous_world_from_object - world_from_object;  // exactly zero where nothing moves
    displacement_to_previous = camera_space_direction((moved * vec4(position, 1.0)).xyz);
#endif
}

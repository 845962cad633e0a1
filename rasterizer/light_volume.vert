// A light's volume, seen from the camera. Instances are lights.
#include "view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in mat4 world_from_unit;  // and locations 2 to 4
layout(location = 5) in int instance_light;

flat out int light;

// The stencil's draw and the light's must touch the same pixels.
invariant gl_Position;

void main() {
    vec3 p = (camera_from_world * (world_from_unit * vec4(position, 1.0))).xyz;
    // Depth is near / distance as in light_volume_depth.frag: reversed, without a far plane.
    gl_Position = vec4(p.xy / tan_half + p.z * view_shift, near_plane, -p.z);
    light = instance_light;
}

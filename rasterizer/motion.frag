// Where each surface point stood in the previous frame, minus where it stands now: pixels, y downwards as image rows.
//
// Depth and the two cameras tell all where the scene stands still; where something moves, the G-buffer says how far
// (DISPLACEMENT). The background moves as if infinitely far away. A point behind the previous camera has no place there:
// +infinity.
#include "view.glsl"

layout(binding = 0) uniform sampler2DArray depth_plane;
#ifdef DISPLACEMENT
layout(binding = 1) uniform sampler2DArray displacement_plane;
#endif
uniform int layer;

layout(location = 0) out vec2 motion;

void main() {
    float depth = texelFetch(depth_plane, ivec3(gl_FragCoord.xy, layer), 0).r;
    // w = 0: a direction. Points are taken relative to the camera first, so that no precision is lost far from the origin.
    vec4 point = is_background(depth) ? vec4(camera_space_point(gl_FragCoord.xy, 1.0), 0.0)
                                      : vec4(camera_space_point(gl_FragCoord.xy, depth), 1.0);
#ifdef DISPLACEMENT
    if (!is_background(depth)) point.xyz += texelFetch(displacement_plane, ivec3(gl_FragCoord.xy, layer), 0).xyz;
#endif
    vec3 previous = (previous_camera_from_camera * point).xyz;
    if (previous.z >= 0.0) {
        motion = vec2(1.0 / 0.0);
        return;
    }
    vec2 previous_pixel = 0.5 * view_size * (previous.xy / (-previous.z * previous_tan_half) + 1.0);
    motion = (previous_pixel - gl_FragCoord.xy) * vec2(1.0, -1.0);
}

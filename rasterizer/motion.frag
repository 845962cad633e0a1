// Where each surface point stood in the previous frame, minus where it stands now: pixels, y downwards as image rows.
//
// Depth and the two cameras tell all where the scene stands still; where something moves, the G-buffer says how far.
// The background moves as if infinitely far away. A point behind the previous camera has no place there: +infinity.
#include "reprojection.glsl"

layout(binding = 0) uniform sampler2DArray depth_plane;
uniform int layer;

layout(location = 0) out vec2 motion;

void main() {
    float depth = texelFetch(depth_plane, ivec3(gl_FragCoord.xy, layer), 0).r;
    PreviousPlace previous = previous_place(ivec2(gl_FragCoord.xy), layer, depth);
    motion = previous.in_front ? (previous.pixel - gl_FragCoord.xy) * vec2(1.0, -1.0) : vec2(1.0 / 0.0);
}

// Depths as fractions of the far plane in few bits.
//
// Defines: LAYER, DEPTH_KEYS (how many values a key has besides 0).
#include "view.glsl"

layout(binding = 0) uniform sampler2DArray depth;

layout(location = 0) out float key;

void main() {
    float metres = texelFetch(depth, ivec3(gl_FragCoord.xy, LAYER), 0).r;
    // A whole number of steps, so that every OpenGL stores the same one.
    key = floor(min(metres / far_plane, 1.0) * DEPTH_KEYS + 0.5) / DEPTH_KEYS;
}

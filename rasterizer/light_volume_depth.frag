// The layer's depth as a hardware depth buffer for light volumes: near / distance, 0 where nothing is seen.
#include "lit_surface.glsl"

void main() {
    gl_FragDepth = near_plane / texelFetch(depth_plane, ivec3(gl_FragCoord.xy, layer), 0).r;
}

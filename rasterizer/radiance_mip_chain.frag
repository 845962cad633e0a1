// One level of one layer of the radiance MIP chain: level 0 from the planes, the others from the level before.
//
// Defines: FIRST_LEVEL (0, 1), and those of surface_radiance.glsl.
#include "view.glsl"
#if FIRST_LEVEL
#include "surface_radiance.glsl"
layout(binding = 0) uniform sampler2DArray depth;
#else
layout(binding = 0) uniform sampler2DArray finer;
uniform int finer_level;
#endif
uniform int layer;

layout(location = 0) out vec4 radiance;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
#if FIRST_LEVEL
    bool empty = is_background(texelFetch(depth, ivec3(texel, layer), 0).r);
    radiance = empty ? vec4(0.0) : vec4(surface_radiance(texel, layer), 1.0);
#else
    radiance = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        radiance += 0.25 * texelFetch(finer, ivec3(2 * texel + ivec2(i & 1, i >> 1), layer), finer_level);
    }
#endif
}

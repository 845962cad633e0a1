// One level of one layer of the depth MIP chain, straight from level 0.

#include "depth_mip_chain.glsl"

layout(binding = 0) uniform sampler2DArray depth;

uniform int layer;
uniform int level;

layout(location = 0) out float subsampled;

void main() {
    subsampled = texelFetch(depth, ivec3(pixel_of_texel(ivec2(gl_FragCoord.xy), level), layer), 0).r;
}

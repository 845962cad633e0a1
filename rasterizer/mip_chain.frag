// One level of one layer of a MIP chain, straight from level 0: texels as they are.

#include "depth_mip_chain.glsl"

layout(binding = 0) uniform sampler2DArray plane;

uniform int layer;
uniform int level;

layout(location = 0) out vec4 subsampled;

void main() {
    subsampled = texelFetch(plane, ivec3(pixel_of_texel(ivec2(gl_FragCoord.xy), level), layer), 0);
}

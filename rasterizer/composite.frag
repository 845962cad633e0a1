// The physical composite: terms added, nothing scaled.
//
// Defines: EMISSION, INDIRECT where there is such a plane.
layout(binding = 0) uniform sampler2DArray direct_plane;
layout(binding = 1) uniform sampler2DArray emission_plane;
layout(binding = 2) uniform sampler2DArray indirect_plane;

layout(location = 0) out vec3 total;

void main() {
    ivec3 texel = ivec3(gl_FragCoord.xy, 0);
    total = texelFetch(direct_plane, texel, 0).rgb;
#ifdef EMISSION
    total += texelFetch(emission_plane, texel, 0).rgb;
#endif
#ifdef INDIRECT
    total += texelFetch(indirect_plane, texel, 0).rgb;
#endif
}

// The sum of all terms, physical or as the demo of Mara et al. weighs them; composite_pass.h has the formulas.
//
// Defines: the texture units of the planes that there are: DIRECT, EMISSION, INDIRECT, REFLECTION; DEMO, and then
// VISIBILITY, with radiosity CONFIDENCE, and where there is ambient light DEPTH, NORMAL, ALBEDO and those of
// ambient_light.glsl.

#ifdef DEPTH
#include "ambient_light.glsl"
#include "normal_encoding.glsl"
layout(binding = DEPTH) uniform sampler2DArray depth_plane;
layout(binding = NORMAL) uniform sampler2DArray normal_plane;
layout(binding = ALBEDO) uniform sampler2DArray albedo_plane;
#endif
layout(binding = DIRECT) uniform sampler2DArray direct_plane;
#ifdef EMISSION
layout(binding = EMISSION) uniform sampler2DArray emission_plane;
#endif
#ifdef INDIRECT
layout(binding = INDIRECT) uniform sampler2DArray indirect_plane;
#endif
#ifdef REFLECTION
layout(binding = REFLECTION) uniform sampler2DArray reflection_plane;
#endif
#ifdef DEMO
layout(binding = VISIBILITY) uniform sampler2DArray visibility_plane;
#endif
#ifdef CONFIDENCE
layout(binding = CONFIDENCE) uniform sampler2DArray confidence_plane;
#endif

layout(location = 0) out vec3 total;

vec3 reflected_ambient(ivec3 texel) {
#ifdef DEPTH
    if (is_background(texelFetch(depth_plane, texel, 0).r)) return vec3(0.0);
    vec3 normal = normal_of_texel(texelFetch(normal_plane, texel, 0));
    return texelFetch(albedo_plane, texel, 0).rgb / 3.14159265 * ambient_irradiance(normal);
#else
    return vec3(0.0);
#endif
}

void main() {
    ivec3 texel = ivec3(gl_FragCoord.xy, 0);
    vec3 direct = texelFetch(direct_plane, texel, 0).rgb, indirect = vec3(0.0);
#ifdef INDIRECT
    indirect = texelFetch(indirect_plane, texel, 0).rgb;
#endif
#ifdef DEMO
    float visibility = 0.95 * texelFetch(visibility_plane, texel, 0).r + 0.05;
    float confidence = 0.0;
#ifdef CONFIDENCE
    confidence = clamp(2.0 * (texelFetch(confidence_plane, texel, 0).r - 0.35) + 0.35, 0.0, 1.0);
#endif
    direct *= mix(1.0, visibility, 0.65);
    indirect *= confidence * visibility;
    indirect += mix(1.0, 0.3, confidence) * visibility * reflected_ambient(texel);
#endif
    total = direct;
#ifdef EMISSION
    total += texelFetch(emission_plane, texel, 0).rgb;
#endif
    total += indirect;
#ifdef REFLECTION
    total += texelFetch(reflection_plane, texel, 0).rgb;
#endif
}

// The sum of all bounces of radiosity, and what is reflected of it; radiosity_sum.h has the formulas.
//
// Defines: BOUNCES; FILL where low confidence is filled, with those of ambient_light.glsl; IRRADIANCE, CONFIDENCE,
// INDIRECT: the output's location, where somebody reads it; those of radiosity_boost.glsl.

#include "radiosity_boost.glsl"
#ifdef FILL
#include "ambient_light.glsl"
#include "normal_encoding.glsl"
#endif

layout(binding = 0) uniform sampler2DArray gathered[BOUNCES];  // rgb: E; a: confidence
layout(binding = 8) uniform sampler2DArray albedo;
#ifdef FILL
layout(binding = 9) uniform sampler2DArray depth;
layout(binding = 10) uniform sampler2DArray normal;
#endif

#ifdef IRRADIANCE
layout(location = IRRADIANCE) out vec3 irradiance;
#endif
#ifdef CONFIDENCE
layout(location = CONFIDENCE) out float confidence;
#endif
#ifdef INDIRECT
layout(location = INDIRECT) out vec3 indirect;
#endif

void main() {
    ivec3 texel = ivec3(gl_FragCoord.xy, 0);
    vec4 first = texelFetch(gathered[0], texel, 0);
    vec3 light = first.rgb, sent = boosted(first.rgb);
    for (int i = 1; i < BOUNCES; ++i) {
        vec3 more = texelFetch(gathered[i], texel, 0).rgb;
        light += more;
        sent += boosted(more);
    }
#ifdef FILL
    if (!is_background(texelFetch(depth, texel, 0).r)) {
        vec3 ambient = ambient_irradiance(normal_of_texel(texelFetch(normal, texel, 0)));
        light = mix(ambient, light, first.a);
        sent = mix(ambient, sent, first.a);
    }
#endif
#ifdef IRRADIANCE
    irradiance = light;
#endif
#ifdef CONFIDENCE
    confidence = first.a;
#endif
#ifdef INDIRECT
    indirect = texelFetch(albedo, texel, 0).rgb / 3.14159265 * sent;
#endif
}

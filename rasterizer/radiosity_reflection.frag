// What a surface reflects of the light that radiosity gathered: albedo / pi E.
//
// Defines: IRRADIANCE, CONFIDENCE, INDIRECT, FIRST_BOUNCE: the output's location, where somebody reads it.

layout(binding = 0) uniform sampler2DArray gathered;  // rgb: E; a: confidence
layout(binding = 1) uniform sampler2DArray albedo;

#ifdef IRRADIANCE
layout(location = IRRADIANCE) out vec3 irradiance;
#endif
#ifdef CONFIDENCE
layout(location = CONFIDENCE) out float confidence;
#endif
#ifdef INDIRECT
layout(location = INDIRECT) out vec3 indirect;
#endif
#ifdef FIRST_BOUNCE
layout(location = FIRST_BOUNCE) out vec3 first_bounce;
#endif

void main() {
    ivec3 texel = ivec3(gl_FragCoord.xy, 0);
    vec4 light = texelFetch(gathered, texel, 0);
    vec3 reflected = texelFetch(albedo, texel, 0).rgb / 3.14159265 * light.rgb;
#ifdef IRRADIANCE
    irradiance = light.rgb;
#endif
#ifdef CONFIDENCE
    confidence = light.a;
#endif
#ifdef INDIRECT
    indirect = reflected;
#endif
#ifdef FIRST_BOUNCE
    first_bounce = reflected;
#endif
}

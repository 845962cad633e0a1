// What a layer reflects of the light that a bounce of radiosity gathered: albedo / pi E.
//
// Defines: LAYER, GATHERED_LAYER (whose E), and those of radiosity_boost.glsl.

#include "radiosity_boost.glsl"

layout(binding = 0) uniform sampler2DArray gathered;  // rgb: E
layout(binding = 1) uniform sampler2DArray albedo;

layout(location = 0) out vec3 reflected;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 light = texelFetch(gathered, ivec3(pixel, GATHERED_LAYER), 0).rgb;
    reflected = texelFetch(albedo, ivec3(pixel, LAYER), 0).rgb / 3.14159265 * boosted(light);
}

// Scattered reads and the arithmetic of a screen-space gather: calibrating_workload.h. Changing a letter here changes what
// every calibrated cost is told by: see calibrating_workload_version.

layout(binding = 0) uniform sampler2D surface;

layout(location = 0) out vec4 gathered;

void main() {
    ivec2 size = textureSize(surface, 0);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 here = texelFetch(surface, pixel, 0);
    float spin = float((3 * pixel.x) ^ (pixel.y + pixel.x * pixel.y));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < TAPS; ++i) {
        float along = (float(i) + 0.5) / float(TAPS);
        float angle = 7.0 * 6.2831853 * along + spin;
        ivec2 tap = pixel + ivec2(40.0 * along * vec2(cos(angle), sin(angle)));
        vec4 there = texelFetch(surface, clamp(tap, ivec2(0), size - 1), 0);
        vec3 across = vec3(vec2(tap - pixel) / vec2(size), there.w - here.w);
        float squared = dot(across, across);
        float facing = max(dot(across, here.xyz), 0.0) * inversesqrt(squared + 1e-4);
        sum += max(1.0 - 4.0 * squared, 0.0) * facing * abs(there.xyz);
    }
    gathered = vec4(sqrt(sum / float(TAPS)), 1.0);
}

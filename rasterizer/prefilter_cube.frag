// One face of one prefiltered level; radiance_maps.h has the formula.
#include "cube_face.glsl"

layout(binding = 0) uniform samplerCube radiance;
uniform int face;
uniform int samples;
uniform float output_size;
uniform float source_size;
uniform float alpha;  // more than 0

layout(location = 0) out vec4 prefiltered;

const float pi = 3.14159265358979;

void main() {
    vec3 r = normalize(cube_point(face, 2.0 * gl_FragCoord.xy / output_size - 1.0));
    vec3 helper = abs(r.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0);
    vec3 u = normalize(cross(helper, r)), v = cross(r, u);
    float texel_angle = 4.0 * pi / (6.0 * source_size * source_size);
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int i = 0; i < samples; ++i) {
        float x = (float(i) + 0.5) / float(samples);
        float azimuth = 2.0 * pi * (float(bitfieldReverse(uint(i))) * 2.3283064365386963e-10);
        // The share x of D(h) (n.h) lies within tan^2 = alpha^2 x / (1 - x).
        float square = (1.0 - x) / (1.0 - x + alpha * alpha * x);  // (r.h)^2
        float cosine = sqrt(square), sine = sqrt(max(0.0, 1.0 - square));
        vec3 h = sine * cos(azimuth) * u + sine * sin(azimuth) * v + cosine * r;
        vec3 d = 2.0 * cosine * h - r;
        float weight = 2.0 * square - 1.0;  // r.d
        if (weight <= 0.0) continue;
        float a2 = alpha * alpha, t = (1.0 - square) + a2 * square;
        float density = a2 / (pi * t * t) / 4.0;  // of d: D(h) (r.h) / (4 r.h)
        float level = 0.5 * log2(1.0 / (float(samples) * density * texel_angle));
        sum += weight * textureLod(radiance, d, max(level, 0.0)).rgb;
        total += weight;
    }
    prefiltered = vec4(sum / total, 1.0);
}

// The environment on one face of a cube: the mean over SUPERSAMPLES^2 directions of each texel.
#include "cube_face.glsl"
#include "environment.glsl"

uniform int face;
uniform float size;

layout(location = 0) out vec4 radiance;

void main() {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < SUPERSAMPLES * SUPERSAMPLES; ++i) {
        vec2 within = (vec2(i % SUPERSAMPLES, i / SUPERSAMPLES) + 0.5) / float(SUPERSAMPLES);
        vec2 st = 2.0 * (floor(gl_FragCoord.xy) + within) / size - 1.0;
        sum += environment_radiance(normalize(cube_point(face, st)));
    }
    radiance = vec4(sum / float(SUPERSAMPLES * SUPERSAMPLES), 1.0);
}

// One face of the irradiance; radiance_maps.h has the formula.
#include "cube_face.glsl"

layout(binding = 0) uniform samplerCube radiance;
uniform int face;
uniform int level;  // of the radiance
uniform int level_size;

layout(location = 0) out vec4 irradiance;

const float output_size = 16.0;

void main() {
    vec3 normal = normalize(cube_point(face, 2.0 * gl_FragCoord.xy / output_size - 1.0));
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int from = 0; from < 6; ++from) {
        for (int y = 0; y < level_size; ++y) {
            vec3 row = vec3(0.0);  // summed by itself: fewer digits are lost than in one long sum
            for (int x = 0; x < level_size; ++x) {
                vec3 p = cube_point(from, 2.0 * (vec2(x, y) + 0.5) / float(level_size) - 1.0);
                float square = dot(p, p);
                // Cosine times solid angle, up to a factor: area / distance^3 of a texel on the cube.
                float weight = max(dot(p, normal), 0.0) / (square * square);
                row += weight * textureLod(radiance, p, float(level)).rgb;
                total += weight;
            }
            sum += row;
        }
    }
    irradiance = vec4(3.14159265 / total * sum, 1.0);
}

// The environment seen directly, where no surface is in front of it.
#include "view.glsl"
#include "environment.glsl"

layout(location = 0) out vec3 emission;

void main() {
    emission = environment_radiance(normalize(world_space_direction(camera_space_point(gl_FragCoord.xy, 1.0))));
}

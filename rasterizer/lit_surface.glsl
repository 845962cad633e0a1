// The surface that a deferred light pass lights: position and normal of one layer's pixel.
#include "normal_encoding.glsl"
#include "view.glsl"

layout(binding = 0) uniform sampler2DArray depth_plane;
layout(binding = 1) uniform sampler2DArray normal_plane;
uniform int layer;

// False where nothing is seen.
bool find_surface(out vec3 receiver, out vec3 normal) {
    ivec3 texel = ivec3(gl_FragCoord.xy, layer);
    float depth = texelFetch(depth_plane, texel, 0).r;
    if (is_background(depth)) return false;
    receiver = world_space_point(gl_FragCoord.xy, depth);
    normal = normal_of_texel(texelFetch(normal_plane, texel, 0));
    return true;
}

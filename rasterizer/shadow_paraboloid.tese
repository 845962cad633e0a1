// Projects onto one of a light's two paraboloids; shadow_lookup.glsl has the way back.
//
// Defines: TEXTURE_COORDINATES.
layout(triangles, equal_spacing, ccw) in;

uniform vec3 light_position;
uniform float side;        // 1: the half towards +z, -1: the other
uniform float overlap;     // sine of the angle by which each half reaches below its horizon
uniform float disc_scale;  // radius of the horizon in the map, whose half side is 1

out float gl_ClipDistance[1];
out vec3 from_light;
#ifdef TEXTURE_COORDINATES
in vec2 patch_uv[];
out vec2 uv;
#endif

void main() {
    vec4 world = gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * gl_in[1].gl_Position +
                 gl_TessCoord.z * gl_in[2].gl_Position;
    from_light = world.xyz - light_position;
    vec3 direction = from_light / max(length(from_light), 1e-20);
    direction.z *= side;
    // What lies far behind is clipped; it only must not become infinite before.
    gl_Position = vec4(disc_scale * direction.xy / max(1.0 + direction.z, 0.01), 0.5, 1.0);
    gl_ClipDistance[0] = direction.z + overlap;
#ifdef TEXTURE_COORDINATES
    uv = gl_TessCoord.x * patch_uv[0] + gl_TessCoord.y * patch_uv[1] + gl_TessCoord.z * patch_uv[2];
#endif
}

// One layer of the G-buffer; gbuffer_pass.h says what the planes hold.
//
// Defines: PEEL (keep only what lies behind the first layer), WRITE_NORMAL, WRITE_ALBEDO, WRITE_EMISSION,
// WRITE_DISPLACEMENT with the location of each output, DISPLACEMENT (of instances that move), and those of material.glsl.
#include "material.glsl"
#include "normal_encoding.glsl"

in vec3 world_normal;
#ifdef TEXTURE_COORDINATES
in vec2 uv;
#else
const vec2 uv = vec2(0.0);
#endif

#ifdef DISPLACEMENT
in vec3 displacement_to_previous;
#endif

#ifdef PEEL
layout(binding = 4) uniform sampler2DArray first_depth;
uniform float minimum_separation;  // metres
#endif

layout(location = 0) out float depth;
#ifdef WRITE_NORMAL
layout(location = WRITE_NORMAL) out vec2 normal;
#endif
#ifdef WRITE_ALBEDO
layout(location = WRITE_ALBEDO) out vec3 albedo;
#endif
#ifdef WRITE_EMISSION
layout(location = WRITE_EMISSION) out vec3 emission;
#endif
#ifdef WRITE_DISPLACEMENT
layout(location = WRITE_DISPLACEMENT) out vec3 displacement;
#endif

void main() {
    // w_clip is the distance along the camera's -Z; its inverse is linear on the screen.
    depth = 1.0 / gl_FragCoord.w;
#ifdef PEEL
    // Also false where the first layer is empty (+infinity).
    if (!(depth > texelFetch(first_depth, ivec3(gl_FragCoord.xy, 0), 0).r + minimum_separation)) discard;
#endif
#ifdef ALPHA_MASK
    if (!is_opaque(uv)) discard;
#endif
    bool dark = two_sided == 0 && !gl_FrontFacing;
#ifdef WRITE_NORMAL
    vec3 n = normalize(world_normal);
    normal = encode_normal(gl_FrontFacing ? n : -n);
#endif
#ifdef WRITE_ALBEDO
    albedo = dark ? vec3(0.0) : surface_albedo(uv);
#endif
#ifdef WRITE_EMISSION
#ifdef EMISSION
    emission = dark ? vec3(0.0) : surface_emission(uv);
#else
    emission = vec3(0.0);
#endif
#endif
#ifdef WRITE_DISPLACEMENT
    displacement = displacement_to_previous;
#endif
}

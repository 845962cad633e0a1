// For alpha-masked surfaces, whose holes cast no shadow, and for maps of linear distances.
//
// Defines: LINEAR_DISTANCE, and those of material.glsl.
#ifdef ALPHA_MASK
#include "material.glsl"
in vec2 uv;
#endif
#ifdef LINEAR_DISTANCE
in vec3 from_light;
uniform float range;  // metres
#endif

void main() {
#ifdef ALPHA_MASK
    if (!is_opaque(uv)) discard;
#endif
#ifdef LINEAR_DISTANCE
    gl_FragDepth = 1.0 - length(from_light) / range;
#endif
}

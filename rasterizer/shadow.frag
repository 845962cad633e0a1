// Only for alpha-masked surfaces: holes cast no shadow.
#include "material.glsl"

in vec2 uv;

void main() {
    if (!is_opaque(uv)) discard;
}

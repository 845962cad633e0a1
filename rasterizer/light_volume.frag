// Adds the irradiance of one light to the pixels of its volume.
//
// Defines: POINT_LIGHTS or SPOT_LIGHTS: which kind it is; COUNT_FRAGMENTS; and those of shadow_lookup.glsl.
#include "lit_surface.glsl"
#include "local_light.glsl"

flat in int light;

layout(location = 0) out vec4 irradiance;

#ifdef COUNT_FRAGMENTS
layout(early_fragment_tests) in;
layout(binding = 0) uniform atomic_uint fragments;
#endif

void main() {
#ifdef COUNT_FRAGMENTS
    atomicCounterIncrement(fragments);
#endif
    irradiance = vec4(0.0);
    vec3 receiver, normal;
    if (!find_surface(receiver, normal)) return;
#ifdef POINT_LIGHTS
    irradiance.rgb = point_irradiance(point_lights[light], receiver, normal);
#else
    irradiance.rgb = spot_irradiance(spot_lights[light], receiver, normal);
#endif
}

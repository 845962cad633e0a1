// How strongly indirect light is reflected over its saturation; radiosity_reflection.h has the formula.
//
// Defines: SATURATED_BOOST and UNSATURATED_BOOST, where they are not both 1.

vec3 boosted(vec3 light) {
#ifdef SATURATED_BOOST
    float largest = max(max(light.r, light.g), light.b), smallest = min(min(light.r, light.g), light.b);
    float saturation = largest > 0.0 ? (largest - smallest) / largest : 0.0;
    return mix(UNSATURATED_BOOST, SATURATED_BOOST, saturation) * light;
#else
    return light;
#endif
}

// What the surface in a pixel of a layer sends to the viewer: what a ray that hits it brings back.
//
// Units 3 and 0 to 2 are the caller's. Defines: BOUNCED (0, 1: the plane `direct` counts), EMISSION (0, 1: there is such
// a plane), INDIRECT (0, 1: of the first layer; it ends at the guard band).

layout(binding = 4) uniform sampler2DArray direct_radiance;
layout(binding = 5) uniform sampler2DArray emitted_radiance;
layout(binding = 6) uniform sampler2DArray indirect_radiance;

vec3 surface_radiance(ivec2 pixel, int layer) {
    vec3 radiance = vec3(0.0);
#if BOUNCED
    radiance += texelFetch(direct_radiance, ivec3(pixel, layer), 0).rgb;
#endif
#if EMISSION
    radiance += texelFetch(emitted_radiance, ivec3(pixel, layer), 0).rgb;
#endif
#if INDIRECT
    ivec2 first = ivec2(first_inner_pixel), end = ivec2(view_size) - first;
    bool inner = all(greaterThanEqual(pixel, first)) && all(lessThan(pixel, end));
    if (layer == 0 && inner) radiance += texelFetch(indirect_radiance, ivec3(pixel, 0), 0).rgb;
#endif
    return radiance;
}

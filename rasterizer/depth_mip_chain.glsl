// Reading the depth of both layers at several resolutions; depth_mip_chain.h says how the chain is made.

#include "view.glsl"

const int maximum_mip_level = 5;

ivec2 image_size = ivec2(view_size);
vec2 ray_scale = 2.0 * tan_half / view_size;
vec2 ray_corner = tan_half * (1.0 - view_shift);  // minus the ray through pixel coordinates (0, 0)

// The pixel of level 0 whose depth a texel of `level` holds.
ivec2 pixel_of_texel(ivec2 texel, int level) {
    ivec2 parity = texel & 1;
    ivec2 bits = parity.yx * 21 + parity * 10;  // 10101 and 01010 in binary
    return (texel << level) | (bits >> (maximum_mip_level - level));
}

// The texel of a level that covers a pixel, or the nearest one to it.
ivec2 texel_at(ivec2 pixel, int level) { return clamp(pixel >> level, ivec2(0), (image_size >> level) - 1); }

// The level for a tap `distance` pixels away.
int mip_level(float distance, int offset, int finest, int coarsest) {
    return clamp(findMSB(int(distance)) - offset, finest, coarsest);
}

bool is_inside(ivec2 pixel) { return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, image_size)); }

// camera_space_point of the pixel's centre, without its division.
vec3 camera_space_point_at(ivec2 pixel, float depth) {
    return depth * vec3((vec2(pixel) + 0.5) * ray_scale - ray_corner, -1.0);
}

// The point of a layer that the pixel of level 0 shows at `depth`, as the method wants it: read (STORED_POSITION, which
// gbuffer_planes.h defines) or computed. Where nothing is, a point so far away that it counts nowhere.
#ifdef STORED_POSITION
layout(binding = 3) uniform sampler2DArray camera_position;
vec3 surface_point(ivec2 pixel, int layer, float depth) {
    return is_background(depth) ? camera_space_point_at(pixel, 1e12)
                                : texelFetch(camera_position, ivec3(pixel, layer), 0).xyz;
}
#else
vec3 surface_point(ivec2 pixel, int layer, float depth) { return camera_space_point_at(pixel, min(depth, 1e12)); }
#endif

// Pixels that `radius` metres cover at a depth. Capped where only the innermost taps could lie in any image, lest pixel
// coordinates overflow.
float radius_in_pixels(float radius, float depth) { return min(radius * pixels_per_metre / depth, 1e7); }

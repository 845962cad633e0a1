// A ray through the layers of the G-buffer; reflections.h says how it is traced.
//
// Defines: LAYERS (1, 2), STEP and FIRST_STEP (pixels), MAX_STEPS, REFINEMENT_STEPS, HIT_IN_FRONT (0, 1: within the
// thickness before a surface, too), HIT_ACROSS (0, 1: between two looks, too), BIAS (metres), TEST_HIT_NORMAL (0, 1),
// MAX_DISTANCE (metres).
#include "depth_mip_chain.glsl"
#include "normal_encoding.glsl"

layout(binding = 0) uniform sampler2DArray depth;
layout(binding = 1) uniform sampler2DArray normal;
uniform float thickness;  // metres

struct RayHit {
    bool found;
    int layer;
    vec2 position;   // where on the screen, pixels
    ivec2 pixel;
    float distance;  // metres
    float height;    // metres above the tangent plane of where the ray starts
};

// Metres until the ray leaves the view's frustum or is long enough. `origin` lies inside.
float length_in_view(vec3 origin, vec3 direction) {
    float end = MAX_DISTANCE;
    if (direction.z > 0.0) end = min(end, (-origin.z - near_plane) / direction.z);
    if (direction.z < 0.0) end = min(end, (far_plane + origin.z) / -direction.z);
    for (int side = -1; side <= 1; side += 2) {
        // Tangents of the sides' angles; a point lies inside where side (x - tangent depth) < 0.
        vec2 tangent = camera_space_point(side > 0 ? view_size : vec2(0.0), 1.0).xy;
        vec2 inside = float(side) * (-origin.z * tangent - origin.xy);
        vec2 outwards = float(side) * (direction.xy + direction.z * tangent);
        if (outwards.x > 0.0) end = min(end, inside.x / outwards.x);
        if (outwards.y > 0.0) end = min(end, inside.y / outwards.y);
    }
    return max(end, 0.0);
}

// A straight line on the screen. Along it the reciprocal depth is linear.
struct ScreenLine {
    vec2 start, slope;  // pixels; slope per pixel of the longer axis, along which it is exactly 1
    float reciprocal_start, reciprocal_slope;
    float length;       // pixels of the longer axis
};

ScreenLine project_ray(vec2 start, vec3 origin, vec3 direction) {
    vec3 end = origin + length_in_view(origin, direction) * direction;
    vec2 across = pixel_of(end) - start;
    ScreenLine line;
    line.start = start;
    line.length = max(abs(across.x), abs(across.y));
    float longer = max(line.length, 1e-6);
    line.slope = across / longer;
    line.reciprocal_start = -1.0 / origin.z;
    line.reciprocal_slope = (-1.0 / end.z - line.reciprocal_start) / longer;
    return line;
}

vec2 position_at(ScreenLine line, float along) { return line.start + along * line.slope; }
ivec2 pixel_at(ScreenLine line, float along) {
    return clamp(ivec2(floor(position_at(line, along))), ivec2(0), image_size - 1);
}
float depth_at(ScreenLine line, float along) { return 1.0 / (line.reciprocal_start + along * line.reciprocal_slope); }

// Whether the ray, between two depths, is inside what is seen in `pixel`, or so near to it that it counts.
bool meets(float one_depth, float other_depth, ivec2 pixel, int layer) {
    float surface = texelFetch(depth, ivec3(pixel, layer), 0).r;
#if HIT_IN_FRONT
    float front = surface - thickness;
#else
    float front = surface;
#endif
    return max(one_depth, other_depth) >= front && min(one_depth, other_depth) <= surface + thickness;
}

// In its own pixel the ray starts at the very depth of the surface: rounding would answer.
bool is_own(ScreenLine line, ivec2 pixel, int layer) { return layer == 0 && pixel == ivec2(line.start); }

// The same of the stretch from `before` on to where the ray has come to `depth_now` in pixel `at`.
bool meets_on_the_way(ScreenLine line, float before, float depth_before, float depth_now, ivec2 at, int layer) {
    bool met = meets(depth_before, depth_now, at, layer);
#if HIT_ACROSS
    ivec2 from = pixel_at(line, before);
    float surface_before = texelFetch(depth, ivec3(from, layer), 0).r;
    bool was_in_front = !is_background(surface_before) && depth_before <= surface_before && !is_own(line, from, layer);
    met = met || (was_in_front && depth_now >= texelFetch(depth, ivec3(at, layer), 0).r);
#endif
    return met;
}

// Narrows the stretch before `along` in which the ray met the layer; tells whether it hit it.
bool refine(ScreenLine line, float before, float along, int layer, vec3 origin, vec3 direction, vec3 camera_normal,
            out RayHit hit) {
    float depth_before = depth_at(line, before);
    for (int i = 0; i < REFINEMENT_STEPS; ++i) {
        float middle = 0.5 * (before + along);
        float depth_middle = depth_at(line, middle);
        ivec2 at = pixel_at(line, middle);
        if (!is_own(line, at, layer) && meets_on_the_way(line, before, depth_before, depth_middle, at, layer)) {
            along = middle;
        } else {
            before = middle;
            depth_before = depth_middle;
        }
    }
    hit.layer = layer;
    hit.position = position_at(line, along);
    hit.pixel = pixel_at(line, along);
    float surface = texelFetch(depth, ivec3(hit.pixel, layer), 0).r;
    vec3 offset = surface_point(hit.pixel, layer, surface) - origin;
    hit.distance = length(offset);
    hit.height = dot(offset, camera_normal);
    hit.found = !is_background(surface) && hit.height > BIAS;
#if TEST_HIT_NORMAL
    vec3 hit_normal = normal_of_texel(texelFetch(normal, ivec3(hit.pixel, layer), 0));
    hit.found = hit.found && dot(world_space_direction(direction), hit_normal) < 0.0;
#endif
    return hit.found;
}

// From the first layer's point `origin` in `pixel`, whose tangent plane has `camera_normal`; all in camera space.
RayHit trace(ivec2 pixel, vec3 origin, vec3 camera_normal, vec3 direction) {
    RayHit hit;
    ScreenLine line = project_ray(vec2(pixel) + 0.5, origin, direction);
    float before = 0.0, depth_before = -origin.z;
    for (int i = 0; i < MAX_STEPS; ++i) {
        float along = FIRST_STEP + float(i) * STEP;
        if (along > line.length) break;
        float depth_now = depth_at(line, along);
        ivec2 at = pixel_at(line, along);
        for (int layer = 0; layer < LAYERS; ++layer) {
            if (meets_on_the_way(line, before, depth_before, depth_now, at, layer) &&
                refine(line, before, along, layer, origin, direction, camera_normal, hit)) {
                return hit;
            }
        }
        before = along;
        depth_before = depth_now;
    }
    hit.found = false;
    return hit;
}

// Where the surface point that a pixel shows was in the frame before (FrameRequest::previous): what moving cameras and
// moving instances have in common. reprojection.h is the other half.
//
// Define: MOVING_INSTANCE_UNIT, the texture unit of the plane `moving_instance`; without it no instance moves.
#include "normal_encoding.glsl"
#include "view.glsl"

#ifdef MOVING_INSTANCE_UNIT
#include "instance_motion.glsl"

layout(binding = MOVING_INSTANCE_UNIT) uniform usampler2DArray moving_instance_plane;

uint moving_instance(ivec2 pixel, int layer) { return texelFetch(moving_instance_plane, ivec3(pixel, layer), 0).r; }
#endif

struct PreviousPlace {
    vec3 point;     // metres, in the camera space of then; of the background: its direction from the camera
    vec2 pixel;     // where the planes of then show it, as gl_FragCoord.xy counts; means nothing where not in_front
    bool in_front;  // of the camera of then; it may still lie outside its image or be hidden
};

// The background stays infinitely far away. Points are taken relative to the camera first, so that no precision is lost
// far from the origin.
PreviousPlace previous_place(ivec2 pixel, int layer, float depth) {
    vec2 centre = vec2(pixel) + 0.5;
    vec4 point = is_background(depth) ? vec4(camera_space_point(centre, 1.0), 0.0)
                                      : vec4(camera_space_point(centre, depth), 1.0);
#ifdef MOVING_INSTANCE_UNIT
    if (!is_background(depth)) point.xyz += displacement_of(moving_instance(pixel, layer), point.xyz);
#endif
    PreviousPlace place;
    place.point = (previous_camera_from_camera * point).xyz;
    place.pixel = previous_pixel_of(place.point);
    place.in_front = place.point.z < 0.0;
    return place;
}

// Where the normal of the surface there pointed, `normal` being that of now; world space, either sign.
vec3 previous_normal(ivec2 pixel, int layer, vec3 normal) {
#ifdef MOVING_INSTANCE_UNIT
    return previous_normal_of(moving_instance(pixel, layer), normal);
#else
    return normal;
#endif
}

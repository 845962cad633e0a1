// The view of the frame, as ViewUniforms (view_uniforms.h) fills it, and the maps between pixels and camera space.
// Camera space looks down -Z; pixel coordinates are gl_FragCoord.xy: lower left first, centres at one half.

layout(std140, binding = 0) uniform ViewBlock {
    mat4 camera_from_world;
    mat4 world_from_camera;
    mat4 clip_from_camera;
    mat4 previous_camera_from_camera;
    vec2 view_size;           // pixels, with the guard band
    vec2 tan_half;            // half the width and height at 1 m depth
    vec2 previous_tan_half;
    float near_plane;         // metres
    float far_plane;
    float pixels_per_metre;   // at 1 m depth
    int first_inner_pixel;    // width of the guard band
    vec2 view_shift;          // of the view against its camera's axis (View::with_offset), in half widths and heights
    mat4 next_camera_from_world;  // of the frame to come
    mat4 next_clip_from_camera;
    vec2 previous_view_shift;
    int frame_number;         // since the last cut, from 0
    ivec2 pattern_shift;      // pixels by which the seed moves all patterns of samples (sample_spiral.h)
};

// Depth planes hold +infinity where nothing is seen.
bool is_background(float depth) { return isinf(depth); }

// The camera-space point at `depth` metres along -Z, seen through `pixel`.
vec3 camera_space_point(vec2 pixel, float depth) {
    return depth * vec3((2.0 * pixel / view_size - 1.0 + view_shift) * tan_half, -1.0);
}

vec3 world_space_point(vec2 pixel, float depth) {
    return (world_from_camera * vec4(camera_space_point(pixel, depth), 1.0)).xyz;
}

// Pixel coordinates of a camera-space point in front of the camera.
vec2 pixel_of(vec3 camera_space) {
    return 0.5 * view_size * (camera_space.xy / (-camera_space.z * tan_half) + 1.0 - view_shift);
}

// The same in the frame before.
vec3 previous_camera_space_point(vec2 pixel, float depth) {
    return depth * vec3((2.0 * pixel / view_size - 1.0 + previous_view_shift) * previous_tan_half, -1.0);
}

vec2 previous_pixel_of(vec3 previous_camera_space) {
    vec2 tangent = previous_camera_space.xy / (-previous_camera_space.z * previous_tan_half);
    return 0.5 * view_size * (tangent + 1.0 - previous_view_shift);
}

// Rotations only, so that they also turn normals.
vec3 camera_space_direction(vec3 world_direction) { return mat3(camera_from_world) * world_direction; }
vec3 world_space_direction(vec3 camera_direction) { return mat3(world_from_camera) * camera_direction; }

// Cuts triangles until the straight edges that the paraboloid map draws bend less than a texel, or as far as it may.
//
// Defines: TEXTURE_COORDINATES.
layout(vertices = 3) out;

uniform vec3 light_position;
uniform float side;     // 1: the half towards +z, -1: the other
uniform float overlap;  // sine of the angle by which each half reaches below its horizon
uniform float most_segments;
uniform float segment_angle;  // radians that a segment should cover, seen from the light

#ifdef TEXTURE_COORDINATES
in vec2 vertex_uv[];
out vec2 patch_uv[];
#endif

// Of the segment from a to b from the origin.
float distance_to_segment(vec3 a, vec3 b) {
    vec3 along = b - a;
    float t = clamp(-dot(a, along) / max(dot(along, along), 1e-30), 0.0, 1.0);
    return length(a + t * along);
}

// The same whichever way the edge is walked, so that neighbours meet without a crack.
float segments(vec3 a, vec3 b) {
    bool swapped = a.x > b.x || (a.x == b.x && (a.y > b.y || (a.y == b.y && a.z > b.z)));
    float distance = swapped ? distance_to_segment(b, a) : distance_to_segment(a, b);
    float length_of_edge = swapped ? length(a - b) : length(b - a);
    return clamp(ceil(length_of_edge / max(segment_angle * distance, 1e-20)), 1.0, most_segments);
}

// The directions that shadow_paraboloid.tese clips are a cone: a triangle lies in it when its corners do.
bool is_clipped(vec3 from_light) { return side * from_light.z < -overlap * length(from_light); }

void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
#ifdef TEXTURE_COORDINATES
    patch_uv[gl_InvocationID] = vertex_uv[gl_InvocationID];
#endif
    if (gl_InvocationID != 0) return;
    vec3 a = gl_in[0].gl_Position.xyz - light_position, b = gl_in[1].gl_Position.xyz - light_position;
    vec3 c = gl_in[2].gl_Position.xyz - light_position;
    if (is_clipped(a) && is_clipped(b) && is_clipped(c)) {  // half of the scene is, and levels of 0 drop it
        gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = gl_TessLevelInner[0] = 0.0;
        return;
    }
    gl_TessLevelOuter[0] = segments(b, c);
    gl_TessLevelOuter[1] = segments(c, a);
    gl_TessLevelOuter[2] = segments(a, b);
    float inner = max(gl_TessLevelOuter[0], max(gl_TessLevelOuter[1], gl_TessLevelOuter[2]));
    // The middle may come nearer to the light than any edge does: where the foot of its perpendicular lies inside.
    vec3 normal = cross(b - a, c - a);
    bool foot_inside = dot(cross(b, c), normal) > 0.0 == dot(cross(c, a), normal) > 0.0 &&
                       dot(cross(a, b), normal) > 0.0 == dot(cross(c, a), normal) > 0.0;
    if (foot_inside) {
        float height = abs(dot(a, normal)) / max(length(normal), 1e-30);
        float longest = max(length(b - a), max(length(c - b), length(a - c)));
        inner = max(inner, ceil(longest / max(segment_angle * height, 1e-20)));
    }
    gl_TessLevelInner[0] = min(inner, most_segments);
}

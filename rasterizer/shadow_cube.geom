// Sends each triangle to those faces of a cube that it may touch: the whole cube in one draw.
//
// Defines: CLIP_PLANE, LINEAR_DISTANCE, TEXTURE_COORDINATES as in shadow.vert.
layout(triangles, invocations = 6) in;
layout(triangle_strip, max_vertices = 3) out;

uniform vec3 light_position;
uniform float near_plane;
uniform int first_layer;

#ifdef CLIP_PLANE
uniform vec4 front_plane;
out float gl_ClipDistance[1];
#endif
#ifdef LINEAR_DISTANCE
out vec3 from_light;
#endif
#ifdef TEXTURE_COORDINATES
in vec2 vertex_uv[];
out vec2 uv;
#endif

// Where OpenGL's cube faces look, and which way is up on them.
const vec3 forward[6] = vec3[](vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1));
const vec3 up[6] = vec3[](vec3(0, -1, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1), vec3(0, -1, 0), vec3(0, -1, 0));

void main() {
    int face = gl_InvocationID;
    vec3 right = cross(forward[face], up[face]);
    vec3 seen[3];  // x, y, distance along the axis
    for (int i = 0; i < 3; ++i) {
        vec3 p = gl_in[i].gl_Position.xyz - light_position;
        seen[i] = vec3(dot(right, p), dot(up[face], p), dot(forward[face], p));
    }
    vec3 x = vec3(seen[0].x, seen[1].x, seen[2].x), y = vec3(seen[0].y, seen[1].y, seen[2].y);
    vec3 w = vec3(seen[0].z, seen[1].z, seen[2].z);
    if (all(lessThan(x, -w)) || all(greaterThan(x, w)) || all(lessThan(y, -w)) || all(greaterThan(y, w))) return;
    for (int i = 0; i < 3; ++i) {
        gl_Layer = first_layer + face;
        gl_Position = vec4(seen[i].xy, near_plane, seen[i].z);
#ifdef CLIP_PLANE
        gl_ClipDistance[0] = dot(front_plane, gl_in[i].gl_Position);
#endif
#ifdef LINEAR_DISTANCE
        from_light = gl_in[i].gl_Position.xyz - light_position;
#endif
#ifdef TEXTURE_COORDINATES
        uv = vertex_uv[i];
#endif
        EmitVertex();
    }
    EndPrimitive();
}

// Directions of the texels of a cube face; cube_faces.h in GLSL.

const vec3 face_forward[6] =
    vec3[](vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1));
const vec3 face_up[6] =
    vec3[](vec3(0, -1, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1), vec3(0, -1, 0), vec3(0, -1, 0));

// Through (s, t) in [-1, 1]^2 of the face; as long as it is to the face of a cube of half side 1.
vec3 cube_point(int face, vec2 st) {
    return face_forward[face] + st.x * cross(face_forward[face], face_up[face]) + st.y * face_up[face];
}

// What a vertex of the G-buffer hands on: the members of a block, after its name SurfaceVertex.
//
// Define: TEXTURE_COORDINATES.
#ifdef TEXTURE_COORDINATES
#define UV_MEMBER vec2 uv;
#else
#define UV_MEMBER
#endif
#define SURFACE_VERTEX_MEMBERS vec3 world_normal; UV_MEMBER

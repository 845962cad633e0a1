// What a vertex of the G-buffer hands on: the members of a block, after its name SurfaceVertex.
//
// Defines: TEXTURE_COORDINATES, MOVING (some instances of the scene move), WRITE_DISPLACEMENT, REPROJECT.
#ifdef TEXTURE_COORDINATES
#define UV_MEMBER vec2 uv;
#else
#define UV_MEMBER
#endif
#if defined(MOVING) && (defined(WRITE_DISPLACEMENT) || defined(REPROJECT))
#define FOLLOW_INSTANCES 1
#define DISPLACEMENT_MEMBER vec3 displacement;
#else
#define DISPLACEMENT_MEMBER
#endif
#define SURFACE_VERTEX_MEMBERS vec3 world_normal; UV_MEMBER DISPLACEMENT_MEMBER

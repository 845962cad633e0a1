// Sends a triangle to every layer of the G-buffer. Defines: LAYERS_AT_ONCE, and those of gbuffer_vertex.glsl.
#include "gbuffer_vertex.glsl"

#if LAYERS_AT_ONCE == 3
#define EMITTED_VERTICES 9
#else
#define EMITTED_VERTICES 6
#endif

layout(triangles) in;
layout(triangle_strip, max_vertices = EMITTED_VERTICES) out;

in SurfaceVertex { SURFACE_VERTEX_MEMBERS } vertices[];
#if LAYERS_AT_ONCE == 3
in vec4 next_position[];
#endif
out SurfaceVertex { SURFACE_VERTEX_MEMBERS } vertex;

void main() {
    for (int layer = 0; layer < LAYERS_AT_ONCE; ++layer) {
        for (int i = 0; i < 3; ++i) {
            gl_Layer = layer;
            gl_Position = gl_in[i].gl_Position;
#if LAYERS_AT_ONCE == 3
            if (layer == 2) gl_Position = next_position[i];
#endif
            vertex.world_normal = vertices[i].world_normal;
#ifdef TEXTURE_COORDINATES
            vertex.uv = vertices[i].uv;
#endif
            EmitVertex();
        }
        EndPrimitive();
    }
}

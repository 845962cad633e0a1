// Pieces of geometry for scenes made by code: boxes, turned shapes, curved sheets, walls with round arches.
//
// Every function appends to a mesh that carries normals and UVs. Triangles are counter-clockwise seen from the side
// that the normals point to, none has zero area. UVs of flat pieces and lathes run in metres times `uv_scale`, so that
// one repeating texture keeps its size on all of them.
//   What stands on something is meant to be sunk into it a little: solids that interpenetrate leave neither cracks
//   between almost equal edges nor two faces in one plane, on which two renderers would disagree.
#pragma once

#include <functional>
#include <span>
#include <string>

#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace plumb {

// Adds `mesh` and one instance of it, moved by `world_from_object`.
void add_object(Scene& scene, Mesh mesh, const glm::mat4& world_from_object = glm::mat4(1.0f));
Mesh make_mesh(std::string name, int material);

// The index of the new vertex.
unsigned append_vertex(Mesh& mesh, const glm::vec3& position, const glm::vec3& normal, const glm::vec2& uv);
// Nothing where two corners coincide, as at the pointed end of a lathe or of a sheet.
void append_triangle(Mesh& mesh, unsigned a, unsigned b, unsigned c);

// A flat parallelogram: corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v; it faces cross(edge_u,
// edge_v).
void append_quad(Mesh& mesh, const glm::vec3& corner, const glm::vec3& edge_u, const glm::vec3& edge_v,
                 float uv_scale = 1.0f);
// The same with UVs from (0, 1) at the corner to (1, 0) at the opposite one: a whole picture, upright.
void append_picture(Mesh& mesh, const glm::vec3& corner, const glm::vec3& edge_u, const glm::vec3& edge_v);

// A closed box, faces outwards.
void append_box(Mesh& mesh, const glm::vec3& lower, const glm::vec3& upper, float uv_scale = 1.0f);
// The same, turned and moved; `place` must be rigid.
void append_box(Mesh& mesh, const glm::vec3& lower, const glm::vec3& upper, const glm::mat4& place,
                float uv_scale = 1.0f);

// A profile of (radius, height) turned about +Y. Its right-hand side, walking along it, is the outside: upwards for the
// outer wall of a vase, downwards for the inner one. Corners sharper than 40 degrees stay sharp. Ends with radius 0
// close.
void append_lathe(Mesh& mesh, std::span<const glm::vec2> profile, int segments, float uv_scale = 1.0f);

// A smooth surface: columns x rows quads over u, v in [0, 1]; it faces cross(d/du, d/dv). UVs are (u, v) times
// `uv_size`. `closed_u`: u = 1 is u = 0 again.
void append_surface(Mesh& mesh, int columns, int rows, const std::function<glm::vec3(float u, float v)>& position,
                    const glm::vec2& uv_size = {1.0f, 1.0f}, bool closed_u = false, bool closed_v = false);

// One bay of a wall with a round arch, from x = left to x = right, centred on z = 0, `thickness` thick. It has no top,
// bottom or sides: those are meant to be sunk into neighbours. Bays with common left and right values join without a
// gap.
struct ArchBay {
    float left = -1.0f, right = 1.0f;
    float bottom = 0.0f;     // where the piers begin; equal to `springing`: none, the wall rests on columns
    float springing = 2.0f;  // where the arch begins
    float top = 4.0f;
    float radius = 0.8f;  // of the opening, centred between left and right
    float thickness = 0.5f;
    int segments = 24;  // of the half circle
};
void append_arch_bay(Mesh& mesh, const ArchBay& bay, float uv_scale = 1.0f);

// Moves what was appended since `first_vertex` by a rigid transform.
void place_vertices(Mesh& mesh, std::size_t first_vertex, const glm::mat4& place);

}  // namespace plumb

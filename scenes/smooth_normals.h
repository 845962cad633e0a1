// Smooth normals for meshes that come without any, or with ones that are not wanted.
#pragma once

#include "scenes/scene.h"

namespace plumb {

// Replaces the mesh's normals. At each corner the normals of the triangles that share its point are averaged, weighted
// by their angle there, over those that lie within `crease_angle` (radians) of the corner's own triangle; so an edge
// sharper than it stays sharp. Points are the same where their coordinates are equal. Corners with equal point, UV and
// normal share a vertex afterwards. Zero-area triangles count for nothing and get the +Y direction: call repair()
// before or after.
//   Source of the weights: Thürmer and Wüthrich 1998, "Computing Vertex Normals from Polygonal Facets".
void make_smooth_normals(Mesh& mesh, float crease_angle);

}  // namespace plumb

// Vertices that are the same in every attribute become one; meshes of one material become one.
#pragma once

#include <vector>

#include "scenes/scene.h"

namespace plumb {

// Exact: no tolerance, which would pull thin triangles together.
void weld(Mesh& mesh);

// The meshes joined into one, which takes the first one's name and material. All must have normals or none, UVs or
// none.
Mesh join(const std::vector<const Mesh*>& meshes);

}  // namespace plumb

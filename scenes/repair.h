// What makes a mesh from a file fit for two renderers that must agree on it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "scenes/scene.h"

namespace plumb {

// What `repair` changed, summed over meshes.
struct RepairCounts {
    std::size_t zero_area_dropped = 0;   // triangles thinner than their coordinates' rounding
    std::size_t duplicates_dropped = 0;  // triangles on the same three points as another one of the mesh
    std::size_t rewound = 0;             // triangles turned round to agree with their normals
    std::size_t normals_replaced = 0;    // corners without a usable normal: the face normal instead
    std::size_t uvs_replaced = 0;        // UVs that are not finite: (0, 0) instead
    std::size_t vertices_dropped = 0;    // vertices that no triangle uses

    RepairCounts& operator+=(const RepairCounts& other);
    bool nothing() const;
    // "1 zero-area triangle dropped, 18 triangles rewound"; "nothing to repair".
    std::string summary() const;
};

// Repairs in place, in this order:
//   an index out of range, a vertex in use that is not finite, normals or UVs that are not one per position: SceneError
//     that names `file`, the mesh and the triangle (nothing sensible can be drawn instead);
//   triangles of zero area, or thinner than the rounding of their own coordinates: dropped (no renderer sees them the
//   same); triangles on the same three points: all but the first dropped (equal depths make a renderer's choice
//   arbitrary); in a
//     one-sided mesh only those that also face the same way;
//   normals of zero length or not finite: the face normal, on vertices of their own; others made unit length;
//   triangles whose winding disagrees with the sum of their normals: turned round, so that the front of OpenGL, the
//     geometric side of the path tracer and the shading normal are one side;
//   vertices that nothing uses: dropped.
RepairCounts repair(Mesh& mesh, std::string_view file, bool two_sided = true);

}  // namespace plumb

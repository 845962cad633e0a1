#include "scenes/weld.h"

#include <array>
#include <unordered_map>
#include <utility>

#include <xxhash.h>

namespace plumb {

void weld(Mesh& mesh) {
    using Vertex = std::array<float, 8>;
    struct Hash {
        std::size_t operator()(const Vertex& vertex) const { return XXH3_64bits(vertex.data(), sizeof vertex); }
    };
    std::unordered_map<Vertex, unsigned, Hash> known;
    known.reserve(mesh.positions.size());
    std::vector<unsigned> new_index(mesh.positions.size());
    unsigned next = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 p = mesh.positions[i];
        const glm::vec3 n = mesh.normals.empty() ? glm::vec3(0.0f) : mesh.normals[i];
        const glm::vec2 uv = mesh.uvs.empty() ? glm::vec2(0.0f) : mesh.uvs[i];
        const auto [vertex, is_new] = known.try_emplace({p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y}, next);
        new_index[i] = vertex->second;
        if (!is_new) continue;
        mesh.positions[next] = p;
        if (!mesh.normals.empty()) mesh.normals[next] = n;
        if (!mesh.uvs.empty()) mesh.uvs[next] = uv;
        ++next;
    }
    mesh.positions.resize(next);
    if (!mesh.normals.empty()) mesh.normals.resize(next);
    if (!mesh.uvs.empty()) mesh.uvs.resize(next);
    for (glm::uvec3& t : mesh.triangles) t = {new_index[t.x], new_index[t.y], new_index[t.z]};
}

Mesh join(const std::vector<const Mesh*>& meshes) {
    Mesh joined;
    joined.name = meshes.front()->name;
    joined.material = meshes.front()->material;
    for (const Mesh* mesh : meshes) {
        const auto first = static_cast<unsigned>(joined.positions.size());
        joined.positions.insert(joined.positions.end(), mesh->positions.begin(), mesh->positions.end());
        joined.normals.insert(joined.normals.end(), mesh->normals.begin(), mesh->normals.end());
        joined.uvs.insert(joined.uvs.end(), mesh->uvs.begin(), mesh->uvs.end());
        for (const glm::uvec3& t : mesh->triangles) joined.triangles.push_back(t + first);
    }
    return joined;
}

}  // namespace plumb

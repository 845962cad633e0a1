#include "scenes/repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_set>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <xxhash.h>

#include "scenes/finite.h"
#include "scenes/scene_error.h"

namespace plumb {
namespace {

void check(const Mesh& mesh, std::string_view file) {
    const std::size_t count = mesh.positions.size();
    const auto check_size = [&](std::size_t size, const char* what) {
        if (size != 0 && size != count) {
            throw SceneError(fmt::format("'{}': mesh '{}' has {} {} for {} vertices; export it again", file, mesh.name,
                                         size, what, count));
        }
    };
    check_size(mesh.normals.size(), "normals");
    check_size(mesh.uvs.size(), "UVs");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            const unsigned index = mesh.triangles[t][corner];
            if (index >= count) {
                throw SceneError(
                    fmt::format("'{}': mesh '{}', triangle {}: vertex index {} is out of range (the mesh has {} "
                                "vertices); the file is damaged, export it again",
                                file, mesh.name, t, index, count));
            }
            const glm::vec3& p = mesh.positions[index];
            if (!finite(p)) {
                throw SceneError(
                    fmt::format("'{}': mesh '{}', triangle {}: vertex {} is ({}, {}, {}), not a finite point; "
                                "correct or delete that vertex",
                                file, mesh.name, t, index, p.x, p.y, p.z));
            }
        }
    }
}

// Twice the area, as a vector along the face normal, free of cancellation for float input.
glm::dvec3 area_vector(const Mesh& mesh, const glm::uvec3& t) {
    const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    return glm::cross(b - a, c - a);
}

// True where the triangle's height is below the rounding of its own float coordinates: its normal is then noise.
bool is_degenerate(const Mesh& mesh, const glm::uvec3& t) {
    const glm::vec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
    const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const glm::vec3 magnitudes = glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
    const double magnitude = std::max({magnitudes.x, magnitudes.y, magnitudes.z});
    const double height_times_longest = glm::length(area_vector(mesh, t));
    return height_times_longest <= std::numeric_limits<float>::epsilon() * magnitude * longest;
}

std::size_t drop_degenerate(Mesh& mesh) {
    return std::erase_if(mesh.triangles, [&](const glm::uvec3& t) { return is_degenerate(mesh, t); });
}

// Triangles as sets of points: corners sorted, with the parity of the sorting as their orientation.
std::size_t drop_duplicates(Mesh& mesh, bool two_sided) {
    using Key = std::array<float, 10>;
    struct Hash {
        std::size_t operator()(const Key& key) const { return XXH3_64bits(key.data(), sizeof key); }
    };
    std::unordered_set<Key, Hash> seen;
    seen.reserve(mesh.triangles.size());
    return std::erase_if(mesh.triangles, [&](const glm::uvec3& t) {
        std::array<std::array<float, 3>, 3> corners;
        for (int i = 0; i < 3; ++i) {
            const glm::vec3 p = mesh.positions[t[i]] + 0.0f;  // -0 becomes 0
            corners[i] = {p.x, p.y, p.z};
        }
        bool odd = false;
        const auto order = [&](int i, int j) {
            if (corners[j] < corners[i]) std::swap(corners[i], corners[j]), odd = !odd;
        };
        order(0, 1), order(1, 2), order(0, 1);
        Key key;
        for (int i = 0; i < 9; ++i) key[i] = corners[i / 3][i % 3];
        key[9] = !two_sided && odd ? 1.0f : 0.0f;
        return !seen.insert(key).second;
    });
}

// Gives corners without a usable normal a vertex of their own with the face normal.
std::size_t replace_bad_normals(Mesh& mesh) {
    if (mesh.normals.empty()) return 0;
    std::vector<bool> bad(mesh.normals.size());
    for (std::size_t i = 0; i < bad.size(); ++i) {
        glm::vec3& normal = mesh.normals[i];
        const float length = glm::length(normal);
        bad[i] = !(std::isfinite(length) && length > 1e-6f);
        if (!bad[i]) normal /= length;
    }
    std::size_t replaced = 0;
    for (glm::uvec3& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const unsigned index = t[corner];
            if (index >= bad.size() || !bad[index]) continue;  // beyond: a vertex added here
            const glm::vec3 position = mesh.positions[index];
            mesh.positions.push_back(position);
            mesh.normals.push_back(glm::vec3(glm::normalize(area_vector(mesh, t))));
            if (!mesh.uvs.empty()) {
                const glm::vec2 uv = mesh.uvs[index];
                mesh.uvs.push_back(uv);
            }
            t[corner] = static_cast<unsigned>(mesh.positions.size() - 1);
            ++replaced;
        }
    }
    return replaced;
}

std::size_t rewind(Mesh& mesh) {
    if (mesh.normals.empty()) return 0;
    std::size_t rewound = 0;
    for (glm::uvec3& t : mesh.triangles) {
        const glm::vec3 normal = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
        if (glm::dot(area_vector(mesh, t), glm::dvec3(normal)) >= 0.0) continue;
        std::swap(t.y, t.z);
        ++rewound;
    }
    return rewound;
}

std::size_t replace_bad_uvs(Mesh& mesh) {
    std::size_t replaced = 0;
    for (glm::vec2& uv : mesh.uvs) {
        if (finite(uv)) continue;
        uv = glm::vec2(0.0f);
        ++replaced;
    }
    return replaced;
}

std::size_t drop_unused_vertices(Mesh& mesh) {
    constexpr unsigned unused = std::numeric_limits<unsigned>::max();
    std::vector<unsigned> new_index(mesh.positions.size(), unused);
    for (const glm::uvec3& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) new_index[t[corner]] = 0;
    }
    unsigned next = 0;
    for (std::size_t i = 0; i < new_index.size(); ++i) {
        if (new_index[i] == unused) continue;
        mesh.positions[next] = mesh.positions[i];
        if (!mesh.normals.empty()) mesh.normals[next] = mesh.normals[i];
        if (!mesh.uvs.empty()) mesh.uvs[next] = mesh.uvs[i];
        new_index[i] = next++;
    }
    const std::size_t dropped = mesh.positions.size() - next;
    if (dropped == 0) return 0;
    mesh.positions.resize(next);
    if (!mesh.normals.empty()) mesh.normals.resize(next);
    if (!mesh.uvs.empty()) mesh.uvs.resize(next);
    for (glm::uvec3& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) t[corner] = new_index[t[corner]];
    }
    return dropped;
}

}  // namespace

RepairCounts& RepairCounts::operator+=(const RepairCounts& other) {
    zero_area_dropped += other.zero_area_dropped;
    duplicates_dropped += other.duplicates_dropped;
    rewound += other.rewound;
    normals_replaced += other.normals_replaced;
    uvs_replaced += other.uvs_replaced;
    vertices_dropped += other.vertices_dropped;
    return *this;
}

bool RepairCounts::nothing() const {
    return zero_area_dropped + duplicates_dropped + rewound + normals_replaced + uvs_replaced + vertices_dropped == 0;
}

std::string RepairCounts::summary() const {
    std::vector<std::string> parts;
    const auto add = [&](std::size_t count, const char* one, const char* many, const char* what) {
        if (count > 0) parts.push_back(fmt::format("{} {} {}", count, count == 1 ? one : many, what));
    };
    add(zero_area_dropped, "zero-area triangle", "zero-area triangles", "dropped");
    add(duplicates_dropped, "duplicate triangle", "duplicate triangles", "dropped");
    add(rewound, "triangle", "triangles", "rewound to agree with the normals");
    add(normals_replaced, "unusable normal", "unusable normals", "replaced by the face normal");
    add(uvs_replaced, "UV", "UVs", "not finite, replaced by (0, 0)");
    add(vertices_dropped, "unused vertex", "unused vertices", "dropped");
    return parts.empty() ? "nothing to repair" : fmt::format("{}", fmt::join(parts, ", "));
}

RepairCounts repair(Mesh& mesh, std::string_view file, bool two_sided) {
    check(mesh, file);
    RepairCounts counts;
    counts.zero_area_dropped = drop_degenerate(mesh);
    counts.duplicates_dropped = drop_duplicates(mesh, two_sided);
    const std::size_t vertices = mesh.positions.size();
    counts.normals_replaced = replace_bad_normals(mesh);
    const std::size_t split = mesh.positions.size() - vertices;
    counts.rewound = rewind(mesh);
    const std::size_t dropped = drop_unused_vertices(mesh);
    counts.vertices_dropped = dropped > split ? dropped - split : 0;  // what was split off is not the file's
    counts.uvs_replaced = replace_bad_uvs(mesh);
    return counts;
}

}  // namespace plumb

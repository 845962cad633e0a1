#include "scenes/smooth_normals.h"

#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include <xxhash.h>

#include "scenes/weld.h"

namespace plumb {
namespace {

using Point = std::array<float, 3>;

struct HashPoint {
    std::size_t operator()(const Point& point) const { return XXH3_64bits(point.data(), sizeof point); }
};

}  // namespace

void make_smooth_normals(Mesh& mesh, float crease_angle) {
    // Which corners meet in each point: corner indices sorted by point, as offsets into one array.
    std::unordered_map<Point, unsigned, HashPoint> point_of_position;
    point_of_position.reserve(mesh.positions.size());
    std::vector<unsigned> point_of_vertex(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 p = mesh.positions[i] + 0.0f;  // -0 becomes 0
        const auto next = static_cast<unsigned>(point_of_position.size());
        point_of_vertex[i] = point_of_position.try_emplace({p.x, p.y, p.z}, next).first->second;
    }
    const std::size_t corners = 3 * mesh.triangles.size();
    const auto point_of_corner = [&](std::size_t corner) {
        return point_of_vertex[mesh.triangles[corner / 3][static_cast<int>(corner % 3)]];
    };
    std::vector<std::size_t> first(point_of_position.size() + 1);
    for (std::size_t corner = 0; corner < corners; ++corner) ++first[point_of_corner(corner) + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    std::vector<std::size_t> corners_of_points(corners), next = first;
    for (std::size_t corner = 0; corner < corners; ++corner)
        corners_of_points[next[point_of_corner(corner)]++] = corner;

    // Face normals, and each corner's angle as its weight.
    std::vector<glm::vec3> face_normals(mesh.triangles.size());
    std::vector<float> weights(corners);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3& triangle = mesh.triangles[t];
        const glm::dvec3 p[3] = {mesh.positions[triangle.x], mesh.positions[triangle.y], mesh.positions[triangle.z]};
        const glm::dvec3 area = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double length = glm::length(area);
        face_normals[t] = length > 0.0 ? glm::vec3(area / length) : glm::vec3(0.0f);
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 a = p[(i + 1) % 3] - p[i], b = p[(i + 2) % 3] - p[i];
            weights[3 * t + i] = static_cast<float>(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
        }
    }

    const float crease = std::cos(crease_angle);
    Mesh smooth;  // every corner a vertex of its own, until they are welded
    smooth.positions.reserve(corners);
    smooth.normals.reserve(corners);
    for (std::size_t corner = 0; corner < corners; ++corner) {
        const glm::vec3& own = face_normals[corner / 3];
        const unsigned point = point_of_corner(corner);
        glm::vec3 sum(0.0f);
        for (std::size_t i = first[point]; i < first[point + 1]; ++i) {
            const std::size_t other = corners_of_points[i];
            const glm::vec3& normal = face_normals[other / 3];
            if (glm::dot(own, normal) >= crease) sum += weights[other] * normal;
        }
        const float length = glm::length(sum);
        const glm::vec3 unusable = own == glm::vec3(0.0f) ? glm::vec3(0, 1, 0) : own;
        const unsigned index = mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
        smooth.positions.push_back(mesh.positions[index]);
        smooth.normals.push_back(length > 1e-6f ? sum / length : unusable);
        if (!mesh.uvs.empty()) smooth.uvs.push_back(mesh.uvs[index]);
    }
    // Indices change only now: until here point_of_corner reads the old ones.
    for (std::size_t corner = 0; corner < corners; ++corner) {
        mesh.triangles[corner / 3][static_cast<int>(corner % 3)] = static_cast<unsigned>(corner);
    }
    mesh.positions = std::move(smooth.positions);
    mesh.normals = std::move(smooth.normals);
    mesh.uvs = std::move(smooth.uvs);
    weld(mesh);
}

}  // namespace plumb

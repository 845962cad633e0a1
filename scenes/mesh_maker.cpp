#include "scenes/mesh_maker.h"

#include <cmath>
#include <utility>
#include <vector>

#include <glm/gtc/constants.hpp>

namespace plumb {
namespace {

void append_flat_polygon(Mesh& mesh, std::span<const glm::vec3> corners, std::span<const glm::vec2> uvs) {
    const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    const auto first = static_cast<unsigned>(mesh.positions.size());
    for (std::size_t i = 0; i < corners.size(); ++i) append_vertex(mesh, corners[i], normal, uvs[i]);
    for (unsigned i = 2; i < corners.size(); ++i) append_triangle(mesh, first, first + i - 1, first + i);
}

// A vertical flat quad in a plane z = const, UVs in metres.
void append_upright(Mesh& mesh, const glm::vec3 (&corners)[4], float uv_scale) {
    glm::vec2 uvs[4];
    for (int i = 0; i < 4; ++i) uvs[i] = uv_scale * glm::vec2(corners[i].x, -corners[i].y);
    append_flat_polygon(mesh, corners, uvs);
}

}  // namespace

unsigned append_vertex(Mesh& mesh, const glm::vec3& position, const glm::vec3& normal, const glm::vec2& uv) {
    mesh.positions.push_back(position);
    mesh.normals.push_back(normal);
    mesh.uvs.push_back(uv);
    return static_cast<unsigned>(mesh.positions.size() - 1);
}

void append_triangle(Mesh& mesh, unsigned a, unsigned b, unsigned c) {
    const glm::vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    if (p == q || q == r || r == p) return;  // the pointed end of a lathe or of a sheet
    mesh.triangles.push_back({a, b, c});
}

Mesh make_mesh(std::string name, int material) {
    Mesh mesh;
    mesh.name = std::move(name);
    mesh.material = material;
    return mesh;
}

void add_object(Scene& scene, Mesh mesh, const glm::mat4& world_from_object) {
    scene.instances.push_back({mesh.name, static_cast<int>(scene.meshes.size()), world_from_object});
    scene.meshes.push_back(std::move(mesh));
}

void append_quad(Mesh& mesh, const glm::vec3& corner, const glm::vec3& edge_u, const glm::vec3& edge_v,
                 float uv_scale) {
    const float width = uv_scale * glm::length(edge_u), height = uv_scale * glm::length(edge_v);
    append_flat_polygon(mesh, std::vector{corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v},
                        std::vector<glm::vec2>{{0.0f, height}, {width, height}, {width, 0.0f}, {0.0f, 0.0f}});
}

void append_picture(Mesh& mesh, const glm::vec3& corner, const glm::vec3& edge_u, const glm::vec3& edge_v) {
    append_flat_polygon(mesh, std::vector{corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v},
                        std::vector<glm::vec2>{{0.0f, 1.0f}, {1.0f, 1.0f}, {1.0f, 0.0f}, {0.0f, 0.0f}});
}

void append_box(Mesh& mesh, const glm::vec3& lower, const glm::vec3& upper, float uv_scale) {
    const glm::vec3 size = upper - lower;
    const glm::vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    append_quad(mesh, lower + z, x, y, uv_scale);       // +z
    append_quad(mesh, lower + x, -x, y, uv_scale);      // -z
    append_quad(mesh, lower + x + z, -z, y, uv_scale);  // +x
    append_quad(mesh, lower, z, y, uv_scale);           // -x
    append_quad(mesh, lower + y + z, x, -z, uv_scale);  // +y
    append_quad(mesh, lower, x, z, uv_scale);           // -y
}

void append_box(Mesh& mesh, const glm::vec3& lower, const glm::vec3& upper, const glm::mat4& place, float uv_scale) {
    const std::size_t first = mesh.positions.size();
    append_box(mesh, lower, upper, uv_scale);
    place_vertices(mesh, first, place);
}

void append_lathe(Mesh& mesh, std::span<const glm::vec2> profile, int segments, float uv_scale) {
    const std::size_t pieces = profile.size() - 1;
    std::vector<glm::vec2> directions(pieces);  // (radial, vertical) normals of the profile's pieces
    for (std::size_t j = 0; j < pieces; ++j) {
        const glm::vec2 along = glm::normalize(profile[j + 1] - profile[j]);
        directions[j] = {along.y, -along.x};
    }
    const float smooth = std::cos(glm::radians(40.0f));
    const auto corner_normal = [&](std::size_t piece, std::size_t neighbour) {
        const bool joins = neighbour < pieces && glm::dot(directions[piece], directions[neighbour]) > smooth;
        return joins ? glm::normalize(directions[piece] + directions[neighbour]) : directions[piece];
    };
    float length = 0.0f;
    for (std::size_t j = 0; j < pieces; ++j) {
        // An index before the first piece wraps to a huge one, which corner_normal takes for no neighbour.
        const glm::vec2 ends[2] = {corner_normal(j, j - 1), corner_normal(j, j + 1)};
        const float next_length = length + glm::distance(profile[j], profile[j + 1]);
        const float radius = std::max(profile[j].x, profile[j + 1].x);
        const auto first = static_cast<unsigned>(mesh.positions.size());
        for (int i = 0; i <= segments; ++i) {
            const float angle = glm::two_pi<float>() * static_cast<float>(i % segments) / static_cast<float>(segments);
            const glm::vec3 radial(std::cos(angle), 0.0f, -std::sin(angle));
            const float around = radius * glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(segments);
            for (int end = 0; end < 2; ++end) {
                const glm::vec2& p = profile[j + end];
                append_vertex(mesh, p.x * radial + glm::vec3(0.0f, p.y, 0.0f),
                              ends[end].x * radial + glm::vec3(0.0f, ends[end].y, 0.0f),
                              uv_scale * glm::vec2(around, -(end == 0 ? length : next_length)));
            }
        }
        for (int i = 0; i < segments; ++i) {
            const unsigned a = first + 2 * i, b = a + 2;
            append_triangle(mesh, a, b, b + 1);
            append_triangle(mesh, a, b + 1, a + 1);
        }
        length = next_length;
    }
}

void append_surface(Mesh& mesh, int columns, int rows, const std::function<glm::vec3(float u, float v)>& position,
                    const glm::vec2& uv_size, bool closed_u, bool closed_v) {
    const auto first = static_cast<unsigned>(mesh.positions.size());
    constexpr float step = 1e-3f;  // for the derivatives: small against a fold, large against float rounding of metres
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const float u = static_cast<float>(closed_u ? i % columns : i) / static_cast<float>(columns);
            const float v = static_cast<float>(closed_v ? j % rows : j) / static_cast<float>(rows);
            const glm::vec3 along_u = position(u + step, v) - position(u - step, v);
            const glm::vec3 along_v = position(u, v + step) - position(u, v - step);
            append_vertex(mesh, position(u, v), glm::normalize(glm::cross(along_u, along_v)),
                          uv_size * glm::vec2(static_cast<float>(i) / static_cast<float>(columns),
                                              static_cast<float>(j) / static_cast<float>(rows)));
        }
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const unsigned a = first + j * (columns + 1) + i, above = a + columns + 1;
            append_triangle(mesh, a, a + 1, above + 1);
            append_triangle(mesh, a, above + 1, above);
        }
    }
}

void append_arch_bay(Mesh& mesh, const ArchBay& bay, float uv_scale) {
    const float centre = 0.5f * (bay.left + bay.right), half = 0.5f * bay.thickness;
    std::vector<glm::vec2> arch(bay.segments + 1), inwards(bay.segments + 1);
    for (int i = 0; i <= bay.segments; ++i) {
        const float angle = glm::pi<float>() * static_cast<float>(bay.segments - i) / static_cast<float>(bay.segments);
        inwards[i] = {-std::cos(angle), -std::sin(angle)};
        arch[i] = {centre + bay.radius * std::cos(angle), bay.springing + bay.radius * std::sin(angle)};
    }
    arch.front().y = arch.back().y = bay.springing;

    // The two faces: pier, one upright strip above each piece of the arch, pier.
    struct Strip {
        glm::vec2 from, to;  // lower ends
    };
    std::vector<Strip> strips = {{{bay.left, bay.bottom}, {arch.front().x, bay.bottom}}};
    for (int i = 0; i < bay.segments; ++i) strips.push_back({arch[i], arch[i + 1]});
    strips.push_back({{arch.back().x, bay.bottom}, {bay.right, bay.bottom}});
    for (const auto& [from, to] : strips) {
        append_upright(mesh, {{from, half}, {to, half}, {to.x, bay.top, half}, {from.x, bay.top, half}}, uv_scale);
        append_upright(mesh, {{to, -half}, {from, -half}, {from.x, bay.top, -half}, {to.x, bay.top, -half}}, uv_scale);
    }

    if (bay.bottom < bay.springing) {  // reveals of the piers
        const glm::vec3 up(0.0f, bay.springing - bay.bottom, 0.0f), through(0.0f, 0.0f, bay.thickness);
        append_quad(mesh, {arch.front().x, bay.bottom, half}, -through, up, uv_scale);
        append_quad(mesh, {arch.back().x, bay.bottom, -half}, through, up, uv_scale);
    }
    const auto first = static_cast<unsigned>(mesh.positions.size());
    const float length = bay.radius * glm::pi<float>();
    for (int i = 0; i <= bay.segments; ++i) {
        const float along = uv_scale * length * static_cast<float>(i) / static_cast<float>(bay.segments);
        append_vertex(mesh, {arch[i], half}, {inwards[i], 0.0f}, {along, 0.0f});
        append_vertex(mesh, {arch[i], -half}, {inwards[i], 0.0f}, {along, uv_scale * bay.thickness});
    }
    for (int i = 0; i < bay.segments; ++i) {
        const unsigned a = first + 2 * i;
        append_triangle(mesh, a, a + 1, a + 3);
        append_triangle(mesh, a, a + 3, a + 2);
    }
}

void place_vertices(Mesh& mesh, std::size_t first_vertex, const glm::mat4& place) {
    for (std::size_t i = first_vertex; i < mesh.positions.size(); ++i) {
        mesh.positions[i] = glm::vec3(place * glm::vec4(mesh.positions[i], 1.0f));
        mesh.normals[i] = glm::normalize(glm::mat3(place) * mesh.normals[i]);
    }
}

}  // namespace plumb

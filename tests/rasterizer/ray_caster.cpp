#include "ray_caster.h"

#include <cmath>

namespace plumb {

RayCaster::RayCaster(const Scene& scene) : scene_(scene) {
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[instance.mesh];
        const glm::dmat4 world(instance.world_from_object);
        const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(world)));
        for (const glm::uvec3& t : mesh.triangles) {
            Triangle triangle{};
            glm::dvec3* corners[3] = {&triangle.a, &triangle.b, &triangle.c};
            for (int k = 0; k < 3; ++k) {
                *corners[k] = glm::dvec3(world * glm::dvec4(glm::dvec3(mesh.positions[t[k]]), 1.0));
                if (!mesh.normals.empty()) triangle.normals[k] = glm::normalize(turn * glm::dvec3(mesh.normals[t[k]]));
                if (!mesh.uvs.empty()) triangle.uvs[k] = glm::dvec2(mesh.uvs[t[k]]);
            }
            triangle.face_normal = mesh.normals.empty();
            triangle.instance = static_cast<int>(i);
            triangle.material = mesh.material;
            triangle.mirrored = glm::determinant(glm::dmat3(world)) < 0.0;
            triangles_.push_back(triangle);
        }
    }
}

CastHit RayCaster::cast(const glm::dvec3& origin, const glm::dvec3& direction, double nearest, double farthest,
                        int ignored_instance) const {
    CastHit best;
    for (const Triangle& triangle : triangles_) {
        if (triangle.instance == ignored_instance) continue;
        // Moeller and Trumbore 1997.
        const glm::dvec3 e1 = triangle.b - triangle.a, e2 = triangle.c - triangle.a;
        const glm::dvec3 p = glm::cross(direction, e2);
        const double determinant = glm::dot(e1, p);
        if (std::abs(determinant) < 1e-14) continue;
        const glm::dvec3 s = origin - triangle.a;
        const double u = glm::dot(s, p) / determinant;
        const glm::dvec3 q = glm::cross(s, e1);
        const double v = glm::dot(direction, q) / determinant;
        const double t = glm::dot(e2, q) / determinant;
        if (u < 0.0 || v < 0.0 || u + v > 1.0 || !(t > nearest) || !(t < farthest)) continue;
        if (best.hit && t >= best.distance) continue;
        const Material& material = scene_.materials[triangle.material];
        const double w = 1.0 - u - v;
        const glm::vec2 uv(w * triangle.uvs[0] + u * triangle.uvs[1] + v * triangle.uvs[2]);
        if (!scene_.is_opaque(material, uv)) continue;
        best.hit = true;
        best.distance = t;
        best.point = origin + t * direction;
        best.instance = triangle.instance;
        glm::dvec3 face = glm::normalize(glm::cross(e1, e2));
        if (triangle.mirrored) face = -face;
        const bool back = glm::dot(face, direction) > 0.0;
        best.normal = triangle.face_normal
                          ? face
                          : glm::normalize(w * triangle.normals[0] + u * triangle.normals[1] + v * triangle.normals[2]);
        if (back) best.normal = -best.normal;
        const bool dark = back && !material.two_sided;
        const SurfaceSample sample = scene_.surface(material, uv);
        best.albedo = dark ? glm::dvec3(0.0) : glm::dvec3(sample.albedo);
        best.emission = dark ? glm::dvec3(0.0) : glm::dvec3(sample.emission);
    }
    return best;
}

bool RayCaster::occluded(const glm::dvec3& from, const glm::dvec3& to, int ignored_instance) const {
    const double distance = glm::length(to - from);
    return cast(from, (to - from) / distance, 1e-4, distance - 1e-4, ignored_instance).hit;
}

RayCaster::Layers RayCaster::layers(const View& view, double minimum_separation) const {
    Layers layers;
    const glm::dvec3 axis = -glm::dvec3(glm::vec3(view.camera().world_from_camera[2]));
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            const Ray ray = view.pixel_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const glm::dvec3 origin(ray.origin), direction = glm::normalize(glm::dvec3(ray.direction));
            const double scale = glm::dot(axis, direction);
            const double farthest = view.camera().far_plane / scale;
            CastHit first = cast(origin, direction, view.camera().near_plane / scale, farthest);
            CastHit second;
            if (first.hit) second = cast(origin, direction, first.distance + minimum_separation / scale, farthest);
            first.depth = first.distance * scale;
            second.depth = second.distance * scale;
            layers.first.push_back(first);
            layers.second.push_back(second);
        }
    }
    return layers;
}

std::vector<bool> away_from_edges(const std::vector<CastHit>& layer, int width, int height) {
    std::vector<bool> away(layer.size(), true);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const CastHit& here = layer[static_cast<std::size_t>(y) * width + x];
            for (int j = std::max(0, y - 1); j <= std::min(height - 1, y + 1); ++j) {
                for (int i = std::max(0, x - 1); i <= std::min(width - 1, x + 1); ++i) {
                    const CastHit& there = layer[static_cast<std::size_t>(j) * width + i];
                    if (here.instance != there.instance ||
                        (here.hit && (glm::dot(here.normal, there.normal) < 0.95 ||
                                      std::abs(glm::dot(here.normal, there.point - here.point)) > 0.02 * here.depth))) {
                        away[static_cast<std::size_t>(y) * width + x] = false;
                    }
                }
            }
        }
    }
    return away;
}

}  // namespace plumb

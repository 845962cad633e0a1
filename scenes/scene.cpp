#include "scenes/scene.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/scene_error.h"

namespace plumb {
namespace {

template <typename Named>
const Named& find_by_name(const std::vector<Named>& items, std::string_view name, std::string_view kind,
                          std::string_view scene) {
    std::vector<std::string> names;
    for (const Named& item : items) {
        if (item.name == name) return item;
        names.push_back(item.name);
    }
    throw SceneError(fmt::format("scene '{}' has no {} '{}'; it has: {}", scene, kind, name,
                                 names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace

const Camera& Scene::camera(std::string_view camera_name) const {
    return find_by_name(cameras, camera_name, "view", name);
}

const CameraPath& Scene::path(std::string_view path_name) const {
    return find_by_name(paths, path_name, "camera path", name);
}

std::size_t Scene::triangle_count() const {
    std::size_t count = 0;
    for (const Instance& instance : instances) count += meshes[instance.mesh].triangles.size();
    return count;
}

Bounds Scene::bounds() const {
    Bounds all;
    for (const Instance& instance : instances) all.add(bounds(instance));
    return all;
}

Bounds Scene::bounds(const Instance& instance) const {
    Bounds bounds;
    for (const glm::vec3& p : meshes[instance.mesh].positions) {
        bounds.add(glm::vec3(instance.world_from_object * glm::vec4(p, 1.0f)));
    }
    return bounds;
}

bool Scene::has_emissive_surfaces() const {
    for (const Instance& instance : instances) {
        if (materials[meshes[instance.mesh].material].is_emissive()) return true;
    }
    return false;
}

void Scene::move_to(double time) {
    for (Instance& instance : instances) {
        if (instance.moves()) instance.world_from_object = instance.motion.pose(time);
    }
}

SurfaceSample Scene::surface(const Material& material, glm::vec2 uv) const {
    return sample_surface(material, [&](int texture) { return textures[texture].sample(uv); });
}

bool Scene::is_opaque(const Material& material, glm::vec2 uv) const {
    return is_surface_opaque(material, [&](int texture) { return textures[texture].sample(uv); });
}

glm::vec3 Scene::environment_radiance(const glm::vec3& direction) const {
    if (environment.texture == no_texture) return environment.radiance;
    const glm::vec2 uv = environment.texture_coordinates(direction);
    return environment.radiance * glm::vec3(textures[environment.texture].sample(uv));
}

float Scene::brightest_emission() const {
    const auto brightest = [this](const glm::vec3& factor, int texture) {
        const float largest = std::max({factor.x, factor.y, factor.z});
        return largest > 0.0f && texture != no_texture ? largest * textures[texture].brightest() : largest;
    };
    float largest = brightest(environment.radiance, environment.texture);
    for (const Material& material : materials) {
        largest = std::max(largest, brightest(material.emission, material.emission_texture));
    }
    return largest;
}

}  // namespace plumb

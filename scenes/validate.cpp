#include "scenes/validate.h"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "scenes/finite.h"
#include "scenes/scene_error.h"

namespace plumb {
namespace {

class Validator {
public:
    explicit Validator(const Scene& scene) : scene_(scene) {}

    void run() const {
        for (const Mesh& mesh : scene_.meshes) check_mesh(mesh);
        for (const Instance& instance : scene_.instances) check_instance(instance);
        for (const Material& material : scene_.materials) check_material(material);
        for (const Texture& texture : scene_.textures) check_texture(texture);
        check_lights();
    }

private:
    template <typename... Arguments>
    [[noreturn]] void fail(fmt::format_string<Arguments...> text, Arguments&&... arguments) const {
        throw SceneError(
            fmt::format("scene '{}': {}", scene_.name, fmt::format(text, std::forward<Arguments>(arguments)...)));
    }

    void check_index(int index, std::size_t size, const std::string& owner, const char* what) const {
        if (index < 0 || static_cast<std::size_t>(index) >= size) {
            fail("{} refers to {} {}, but there are {}", owner, what, index, size);
        }
    }
    void check_texture_index(int index, const Material& material) const {
        if (index != no_texture) {
            check_index(index, scene_.textures.size(), fmt::format("material '{}'", material.name), "texture");
        }
    }
    void check_light(const glm::vec3& value, const char* kind, const std::string& name) const {
        if (!finite(value) || value.x < 0.0f || value.y < 0.0f || value.z < 0.0f) {
            fail("{} '{}' has ({}, {}, {}); light must be finite and not negative", kind, name, value.x, value.y,
                 value.z);
        }
    }
    void check_direction(const glm::vec3& direction, const char* kind, const std::string& name) const {
        // 1e-3: what a direction typed with four digits is off.
        if (!(std::abs(glm::length(direction) - 1.0f) < 1e-3f)) {
            fail("{} '{}': direction ({}, {}, {}) is not of unit length", kind, name, direction.x, direction.y,
                 direction.z);
        }
    }

    void check_attenuation(const Attenuation& attenuation, const char* kind, const std::string& name) const {
        const auto& [constant, linear, quadratic] = attenuation;
        const float sum = constant + linear + quadratic;
        if (!(constant >= 0.0f && linear >= 0.0f && quadratic >= 0.0f && sum > 0.0f && finite(sum))) {
            fail("{} '{}': attenuation terms {}, {} and {} must be finite, not negative and not all 0", kind, name,
                 constant, linear, quadratic);
        }
    }

    void check_mesh(const Mesh& mesh) const {
        check_index(mesh.material, scene_.materials.size(), fmt::format("mesh '{}'", mesh.name), "material");
        const std::size_t count = mesh.positions.size();
        if (!mesh.normals.empty() && mesh.normals.size() != count) {
            fail("mesh '{}' has {} normals for {} positions", mesh.name, mesh.normals.size(), count);
        }
        if (!mesh.uvs.empty() && mesh.uvs.size() != count) {
            fail("mesh '{}' has {} UVs for {} positions", mesh.name, mesh.uvs.size(), count);
        }
        for (std::size_t i = 0; i < count; ++i) {
            if (!finite(mesh.positions[i])) fail("mesh '{}': position {} is not finite", mesh.name, i);
            if (!mesh.uvs.empty() && !finite(mesh.uvs[i])) fail("mesh '{}': UV {} is not finite", mesh.name, i);
            // 1e-4: float rounding of a normalised vector is 1e-7; files round to a few digits before.
            if (!mesh.normals.empty() && !(std::abs(glm::length(mesh.normals[i]) - 1.0f) < 1e-4f)) {
                fail("mesh '{}': normal {} has length {}", mesh.name, i, glm::length(mesh.normals[i]));
            }
        }
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) check_triangle(mesh, t);
    }

    void check_triangle(const Mesh& mesh, std::size_t index) const {
        const glm::uvec3& t = mesh.triangles[index];
        for (int corner = 0; corner < 3; ++corner) {
            if (t[corner] >= mesh.positions.size()) {
                fail("mesh '{}', triangle {}: vertex index {} of {}", mesh.name, index, t[corner],
                     mesh.positions.size());
            }
        }
        const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const glm::dvec3 face = glm::cross(b - a, c - a);
        if (!(glm::dot(face, face) > 0.0)) fail("mesh '{}': triangle {} has zero area", mesh.name, index);
        if (mesh.normals.empty()) return;
        const glm::dvec3 normal = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
        if (glm::dot(face, normal) < 0.0) {
            fail("mesh '{}': triangle {} is wound against its normals", mesh.name, index);
        }
    }

    void check_instance(const Instance& instance) const {
        const std::string owner = fmt::format("instance '{}'", instance.name);
        check_index(instance.mesh, scene_.meshes.size(), owner, "mesh");
        const float determinant = glm::determinant(glm::mat3(instance.world_from_object));
        if (!(determinant > 0.0f && finite(determinant) && finite(glm::vec3(instance.world_from_object[3])))) {
            fail("{} has a transform of determinant {}; it must not mirror, flatten or be infinite", owner,
                 determinant);
        }
        try {
            if (instance.moves()) instance.motion.check();
        } catch (const SceneError& error) {
            fail("{}: {}", owner, error.what());
        }
    }

    void check_fraction(const glm::vec3& value, const char* what, const Material& material) const {
        const bool possible = finite(value) && glm::all(glm::greaterThanEqual(value, glm::vec3(0.0f))) &&
                              glm::all(glm::lessThanEqual(value, glm::vec3(1.0f)));
        if (!possible) {
            fail("material '{}': {} ({}, {}, {}) must lie between 0 and 1", material.name, what, value.x, value.y,
                 value.z);
        }
    }

    void check_material(const Material& material) const {
        check_fraction(material.base_colour, "base colour", material);
        if (!(material.metallic >= 0.0f && material.metallic <= 1.0f && material.roughness >= 0.0f &&
              material.roughness <= 1.0f)) {
            fail("material '{}': metallic {} and roughness {} must lie between 0 and 1", material.name,
                 material.metallic, material.roughness);
        }
        check_fraction(glm::vec3(material.dielectric_reflectance), "dielectric reflectance", material);
        check_fraction(material.transmission, "transmission", material);
        // 1e-5: what rounding makes of d * colour + (1 - d).
        const glm::vec3 out = material.base_colour + material.transmission;
        if (!glm::all(glm::lessThanEqual(out, glm::vec3(1.0f + 1e-5f)))) {
            fail(
                "material '{}': base colour and transmission add up to ({}, {}, {}); more light would leave than "
                "arrives, lower one of them",
                material.name, out.x, out.y, out.z);
        }
        check_light(material.emission, "material", material.name);
        check_texture_index(material.base_colour_texture, material);
        check_texture_index(material.metallic_roughness_texture, material);
        check_texture_index(material.emission_texture, material);
        check_texture_index(material.alpha_texture, material);
        if (material.alpha_channel < 0 || material.alpha_channel > 3) {
            fail("material '{}': alpha channel {} must be 0 to 3", material.name, material.alpha_channel);
        }
    }

    void check_texture(const Texture& texture) const {
        if (texture.width <= 0 || texture.height <= 0 ||
            texture.value_count() != 4 * static_cast<std::size_t>(texture.width) * texture.height) {
            fail("texture '{}' is {}x{} with {} values", texture.name, texture.width, texture.height,
                 texture.value_count());
        }
    }

    void check_lights() const {
        for (const PointLight& light : scene_.point_lights) {
            check_light(light.intensity, "point light", light.name);
            check_attenuation(light.attenuation, "point light", light.name);
            if (!finite(light.position)) fail("point light '{}': its position is not finite", light.name);
        }
        for (const SpotLight& light : scene_.spot_lights) {
            check_light(light.intensity, "spot light", light.name);
            check_attenuation(light.attenuation, "spot light", light.name);
            check_direction(light.direction, "spot light", light.name);
            if (!finite(light.position)) fail("spot light '{}': its position is not finite", light.name);
            if (!(light.inner_angle >= 0.0f && light.inner_angle < light.outer_angle && light.outer_angle < 1.5708f)) {
                fail("spot light '{}': half angles {} and {} must satisfy 0 <= inner < outer < pi / 2", light.name,
                     light.inner_angle, light.outer_angle);
            }
        }
        for (const DirectionalLight& light : scene_.directional_lights) {
            check_light(light.irradiance, "directional light", light.name);
            check_direction(light.direction, "directional light", light.name);
            if (!(light.angular_radius >= 0.0f && light.angular_radius < 1.5707f)) {
                fail("directional light '{}': angular radius {} must lie between 0 and pi / 2", light.name,
                     light.angular_radius);
            }
        }
        check_light(scene_.environment.radiance, "environment", "");
        if (!finite(scene_.environment.rotation)) fail("the environment's rotation is not finite");
        if (scene_.environment.texture != no_texture) {
            check_index(scene_.environment.texture, scene_.textures.size(), "the environment", "texture");
        }
    }

    const Scene& scene_;
};

}  // namespace

void validate(const Scene& scene) { Validator(scene).run(); }

}  // namespace plumb

#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include <xxhash.h>

#include "scenes/scene.h"

namespace plumb {
namespace {

// Feeds values field by field (never whole structs, whose padding bytes are arbitrary) into one XXH3 stream.
class Hasher {
public:
    Hasher() : state_(XXH3_createState(), XXH3_freeState) { XXH3_64bits_reset(state_.get()); }

    template <typename T>
    void add(const T& value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        XXH3_64bits_update(state_.get(), &value, sizeof value);
    }
    template <int size, typename T>
    void add(const glm::vec<size, T>& value) {
        XXH3_64bits_update(state_.get(), &value, sizeof value);
    }
    void add(const glm::mat4& value) { XXH3_64bits_update(state_.get(), &value, sizeof value); }
    template <typename T>
    void add(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        add(values.size());
        XXH3_64bits_update(state_.get(), values.data(), values.size() * sizeof(T));
    }
    std::uint64_t digest() const { return XXH3_64bits_digest(state_.get()); }

private:
    std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state_;
};

void add(Hasher& hasher, const Attenuation& attenuation) {
    hasher.add(attenuation.constant);
    hasher.add(attenuation.linear);
    hasher.add(attenuation.quadratic);
}

void add(Hasher& hasher, const Motion& motion) {
    hasher.add(motion.keys.size());
    if (motion.keys.empty()) return;  // the rest means nothing
    hasher.add(motion.interpolation);
    hasher.add(motion.rest);
    hasher.add(motion.pivot);
    for (const MotionKey& key : motion.keys) {
        hasher.add(key.time);
        hasher.add(key.translation);
        for (const float component : {key.rotation.w, key.rotation.x, key.rotation.y, key.rotation.z}) {
            hasher.add(component);
        }
        hasher.add(key.scale);
    }
}

}  // namespace

std::uint64_t Scene::content_hash() const {
    Hasher hasher;
    hasher.add(meshes.size());
    for (const Mesh& mesh : meshes) {
        hasher.add(mesh.positions);
        hasher.add(mesh.normals);
        hasher.add(mesh.uvs);
        hasher.add(mesh.triangles);
        hasher.add(mesh.material);
    }
    hasher.add(instances.size());
    for (const Instance& instance : instances) {
        hasher.add(instance.mesh);
        hasher.add(instance.world_from_object);
        add(hasher, instance.motion);
    }
    hasher.add(materials.size());
    for (const Material& material : materials) {
        hasher.add(material.base_colour);
        hasher.add(material.base_colour_texture);
        hasher.add(material.metallic);
        hasher.add(material.roughness);
        hasher.add(material.metallic_roughness_texture);
        hasher.add(material.dielectric_reflectance);
        hasher.add(material.transmission);
        hasher.add(material.emission);
        hasher.add(material.emission_texture);
        hasher.add(material.alpha_mask);
        hasher.add(material.alpha_cutoff);
        hasher.add(material.alpha_texture);
        hasher.add(material.alpha_channel);
        hasher.add(material.two_sided);
    }
    hasher.add(textures.size());
    for (const Texture& texture : textures) {
        hasher.add(texture.width);
        hasher.add(texture.height);
        hasher.add(texture.wrap_u);
        hasher.add(texture.wrap_v);
        hasher.add(texture.texels);
        if (texture.is_wide()) hasher.add(texture.wide_texels);
    }
    hasher.add(point_lights.size());
    for (const PointLight& light : point_lights) {
        hasher.add(light.position);
        hasher.add(light.intensity);
        add(hasher, light.attenuation);
    }
    hasher.add(spot_lights.size());
    for (const SpotLight& light : spot_lights) {
        hasher.add(light.position);
        hasher.add(light.direction);
        hasher.add(light.intensity);
        hasher.add(light.inner_angle);
        hasher.add(light.outer_angle);
        add(hasher, light.attenuation);
    }
    hasher.add(directional_lights.size());
    for (const DirectionalLight& light : directional_lights) {
        hasher.add(light.direction);
        hasher.add(light.irradiance);
        hasher.add(light.angular_radius);
    }
    hasher.add(environment.radiance);
    hasher.add(environment.texture);
    hasher.add(environment.rotation);
    return hasher.digest();
}

}  // namespace plumb

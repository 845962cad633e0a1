#include "scenes/effects.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumb {
namespace {

std::vector<const Material*> materials_in_use(const Scene& scene) {
    std::vector<bool> used(scene.materials.size());
    for (const Instance& instance : scene.instances) used[scene.meshes[instance.mesh].material] = true;
    std::vector<const Material*> materials;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i]) materials.push_back(&scene.materials[i]);
    }
    return materials;
}

// "leaf, chain, vase_plant and 7 more"
std::string list_of(std::vector<std::string> names) {
    constexpr std::size_t shown = 5;
    const std::string rest = names.size() > shown ? fmt::format(" and {} more", names.size() - shown) : "";
    names.resize(std::min(names.size(), shown));
    return fmt::format("{}{}", fmt::join(names, ", "), rest);
}

template <typename Property>
Effect of_materials(EffectKind kind, const std::vector<const Material*>& materials, Property has_property) {
    std::vector<std::string> names;
    for (const Material* material : materials) {
        if (has_property(*material)) names.push_back(material->name);
    }
    if (names.empty()) return {kind, false, fmt::format("none of {} materials in use", materials.size())};
    return {kind, true, fmt::format("{} of {} materials in use: {}", names.size(), materials.size(), list_of(names))};
}

// Appends the names of the elements that have a property.
template <typename Named, typename Property>
void add_names(std::vector<std::string>& names, const std::vector<Named>& elements, Property has_property) {
    for (const Named& element : elements) {
        if (has_property(element)) names.push_back(element.name.empty() ? "unnamed" : element.name);
    }
}

Effect of_names(EffectKind kind, const std::vector<std::string>& names, const std::string& reason_if_none) {
    if (names.empty()) return {kind, false, reason_if_none};
    return {kind, true, fmt::format("{}: {}", names.size(), list_of(names))};
}

template <typename Light>
Effect of_lights(EffectKind kind, const std::vector<Light>& lights) {
    std::vector<std::string> names;
    add_names(names, lights, [](const Light&) { return true; });
    return of_names(kind, names, "the scene has none");
}

bool uses_texture(const Material& m) {
    return std::max({m.base_colour_texture, m.metallic_roughness_texture, m.emission_texture, m.alpha_texture}) >= 0;
}

}  // namespace

const char* to_string(EffectKind kind) {
    switch (kind) {
        case EffectKind::emissive_surfaces:
            return "emissive surfaces";
        case EffectKind::point_lights:
            return "point lights";
        case EffectKind::spot_lights:
            return "spot lights";
        case EffectKind::directional_lights:
            return "directional lights";
        case EffectKind::environment:
            return "environment";
        case EffectKind::environment_image:
            return "environment image";
        case EffectKind::glossy_surfaces:
            return "glossy surfaces";
        case EffectKind::alpha_masks:
            return "alpha masks";
        case EffectKind::textures:
            return "textures";
        case EffectKind::one_sided_surfaces:
            return "one-sided surfaces";
        case EffectKind::transparency:
            return "transparency";
        case EffectKind::moving_objects:
            return "moving objects";
        case EffectKind::lens:
            return "lens";
        case EffectKind::attenuation:
            return "attenuation";
        case EffectKind::sun_discs:
            return "sun discs";
    }
    return "";
}

bool EffectPlan::on(EffectKind kind) const { return (*this)[kind].on; }

EffectPlan plan_effects(const Scene& scene) {
    const std::vector<const Material*> materials = materials_in_use(scene);
    const Environment& environment = scene.environment;
    const glm::vec3& sky = environment.radiance;
    const auto has_lens = [](const auto& camera) { return camera.aperture_radius > 0.0f; };
    const auto falls_off_otherwise = [](const auto& light) { return !light.attenuation.is_inverse_square(); };
    const auto is_disc = [](const DirectionalLight& light) { return light.angular_radius > 0.0f; };
    std::vector<std::string> moving, lenses, attenuated, discs;
    add_names(moving, scene.instances, [](const Instance& instance) { return instance.moves(); });
    add_names(lenses, scene.cameras, has_lens);
    add_names(lenses, scene.paths, has_lens);
    add_names(attenuated, scene.point_lights, falls_off_otherwise);
    add_names(attenuated, scene.spot_lights, falls_off_otherwise);
    add_names(discs, scene.directional_lights, is_disc);
    EffectPlan plan;
    plan.effects = {
        of_materials(EffectKind::emissive_surfaces, materials, [](const Material& m) { return m.is_emissive(); }),
        of_lights(EffectKind::point_lights, scene.point_lights),
        of_lights(EffectKind::spot_lights, scene.spot_lights),
        of_lights(EffectKind::directional_lights, scene.directional_lights),
        {EffectKind::environment, !environment.is_black(),
         fmt::format("radiance ({:g}, {:g}, {:g})", sky.x, sky.y, sky.z)},
        {EffectKind::environment_image, !environment.is_black() && environment.texture != no_texture,
         environment.texture == no_texture ? "the environment is constant" : scene.textures[environment.texture].name},
        of_materials(EffectKind::glossy_surfaces, materials, [](const Material& m) { return m.has_specular_lobe(); }),
        of_materials(EffectKind::alpha_masks, materials, [](const Material& m) { return m.alpha_mask; }),
        of_materials(EffectKind::textures, materials, uses_texture),
        of_materials(EffectKind::one_sided_surfaces, materials, [](const Material& m) { return !m.two_sided; }),
        of_materials(EffectKind::transparency, materials, [](const Material& m) { return m.is_transparent(); }),
        of_names(EffectKind::moving_objects, moving,
                 fmt::format("all {} instances stand still", scene.instances.size())),
        of_names(EffectKind::lens, lenses, "all cameras are pinholes"),
        of_names(EffectKind::attenuation, attenuated, "all lamps fall off with the squared distance"),
        of_names(EffectKind::sun_discs, discs, "no directional light has an angular radius"),
    };
    return plan;
}

}  // namespace plumb

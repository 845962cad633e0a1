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

template <typename Property>
Effect of_materials(EffectKind kind, const std::vector<const Material*>& materials, Property has_property) {
    std::vector<std::string> names;
    for (const Material* material : materials) {
        if (has_property(*material)) names.push_back(material->name);
    }
    if (names.empty()) return {kind, false, fmt::format("none of {} materials in use", materials.size())};
    constexpr std::size_t shown = 5;
    const std::string rest = names.size() > shown ? fmt::format(" and {} more", names.size() - shown) : "";
    const std::size_t count = names.size();
    names.resize(std::min(count, shown));
    return {kind, true,
            fmt::format("{} of {} materials in use: {}{}", count, materials.size(), fmt::join(names, ", "), rest)};
}

template <typename Light>
Effect of_lights(EffectKind kind, const std::vector<Light>& lights) {
    if (lights.empty()) return {kind, false, "the scene has none"};
    std::vector<std::string> names;
    for (const Light& light : lights) names.push_back(light.name.empty() ? "unnamed" : light.name);
    return {kind, true, fmt::format("{}: {}", lights.size(), fmt::join(names, ", "))};
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
        case EffectKind::refraction:
            return "refraction";
        case EffectKind::moving_objects:
            return "moving objects";
        case EffectKind::lens:
            return "lens";
    }
    return "";
}

bool EffectPlan::on(EffectKind kind) const { return (*this)[kind].on; }

EffectPlan plan_effects(const Scene& scene) {
    const std::vector<const Material*> materials = materials_in_use(scene);
    const Environment& environment = scene.environment;
    const glm::vec3& sky = environment.radiance;
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
        of_materials(EffectKind::glossy_surfaces, materials,
                     [](const Material& m) { return m.metallic > 0.0f || m.roughness < 1.0f; }),
        of_materials(EffectKind::alpha_masks, materials, [](const Material& m) { return m.alpha_mask; }),
        of_materials(EffectKind::textures, materials, uses_texture),
        of_materials(EffectKind::one_sided_surfaces, materials, [](const Material& m) { return !m.two_sided; }),
        {EffectKind::refraction, false, "materials have no transparency but alpha masks"},
        {EffectKind::moving_objects, false, "instances stand still, only cameras move"},
        {EffectKind::lens, false, "cameras are pinholes"},
    };
    return plan;
}

}  // namespace plumb

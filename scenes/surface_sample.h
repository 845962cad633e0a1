// What a material is at one point, whoever looks up its textures.
#pragma once

#include <glm/glm.hpp>

#include "scenes/material.h"

namespace plumb {

// Textures looked up. Alpha-masked holes are told by `is_surface_opaque`.
struct SurfaceSample {
    glm::vec3 albedo{0.0f};  // diffuse reflectance: base colour * (1 - metallic)
    glm::vec3 base_colour{0.0f};
    glm::vec3 emission{0.0f};
    float metallic = 0.0f;
    float roughness = 1.0f;
    glm::vec3 specular_f0{0.0f};  // of the specular lobe, see material.h; f0 = f90 = 0: there is none
    glm::vec3 specular_f90{0.0f};
    glm::vec3 transmission{0.0f};
};

// `texel(texture)` is the value of a texture at the point, a glm::vec4.
template <typename Texel>
SurfaceSample sample_surface(const Material& material, const Texel& texel) {
    SurfaceSample sample;
    sample.base_colour = material.base_colour;
    if (material.base_colour_texture != no_texture) {
        sample.base_colour *= glm::vec3(texel(material.base_colour_texture));
    }
    sample.metallic = material.metallic;
    sample.roughness = material.roughness;
    if (material.metallic_roughness_texture != no_texture) {
        const glm::vec4 value = texel(material.metallic_roughness_texture);
        sample.roughness *= value.y;
        sample.metallic *= value.z;
    }
    sample.emission = material.emission;
    if (material.emission_texture != no_texture) sample.emission *= glm::vec3(texel(material.emission_texture));
    sample.albedo = sample.base_colour * (1.0f - sample.metallic);
    const float dielectric_f90 = material.dielectric_reflectance > 0.0f ? 1.0f : 0.0f;
    sample.specular_f0 = glm::mix(glm::vec3(material.dielectric_reflectance), sample.base_colour, sample.metallic);
    sample.specular_f90 = glm::vec3(glm::mix(dielectric_f90, 1.0f, sample.metallic));
    sample.transmission = material.transmission;
    return sample;
}

// False in an alpha-masked hole.
template <typename Texel>
bool is_surface_opaque(const Material& material, const Texel& texel) {
    if (!material.alpha_mask) return true;
    if (material.alpha_texture != no_texture) {
        return texel(material.alpha_texture)[material.alpha_channel] >= material.alpha_cutoff;
    }
    if (material.base_colour_texture == no_texture) return true;
    return texel(material.base_colour_texture).w >= material.alpha_cutoff;
}

}  // namespace plumb

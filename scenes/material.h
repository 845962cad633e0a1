// The one material model: glTF's metallic-roughness with alpha mask, emission and thin transparency.
//
// A surface has up to three lobes. Diffuse: Lambertian, base colour * (1 - metallic). Specular: a GGX microfacet
// surface with Schlick's Fresnel term between f0 = mix(dielectric_reflectance, base colour, metallic) at normal and f90
// = mix(dielectric_reflectance > 0 ? 1 : 0, 1, metallic) at grazing incidence; where dielectric_reflectance and
// metallic are 0 there is none. Straight through: a thin sheet lets the fraction `transmission` of light pass, unbent.
#pragma once

#include <string>

#include <glm/glm.hpp>

namespace plumb {

constexpr int no_texture = -1;  // indices below refer to Scene::textures

struct Material {
    std::string name;
    glm::vec3 base_colour{0.8f};  // linear; multiplies the texture
    int base_colour_texture = no_texture;
    float metallic = 0.0f;                        // 0: Lambertian albedo = base_colour; 1: no diffuse part
    float roughness = 1.0f;                       // perceptual, as glTF (GGX alpha = roughness^2)
    int metallic_roughness_texture = no_texture;  // roughness in G, metallic in B
    float dielectric_reflectance = 0.0f;          // specular reflectance of the non-metallic part at normal incidence
                                                  // (glTF: 0.04); 0: that part is Lambertian, without a specular lobe
    glm::vec3 transmission{0.0f};  // fraction of light that passes straight through; 0: opaque. The other
                                   // lobes do not shrink by it: base_colour + transmission must not exceed 1
    glm::vec3 emission{0.0f};      // radiance in W / (m^2 sr), linear; leaves both sides where two_sided
    int emission_texture = no_texture;
    bool alpha_mask = false;  // surface exists only where alpha >= alpha_cutoff
    float alpha_cutoff = 0.5f;
    int alpha_texture = no_texture;  // separate mask; no_texture: alpha of the base colour texture
    int alpha_channel = 3;           // channel of alpha_texture that holds the mask
    bool two_sided = true;           // false: the surface neither reflects nor emits on its back, where it is black

    bool is_emissive() const { return emission.x > 0.0f || emission.y > 0.0f || emission.z > 0.0f; }
    // Somewhere: a texture multiplies `metallic` and may take it away.
    bool has_specular_lobe() const { return dielectric_reflectance > 0.0f || metallic > 0.0f; }
    bool is_transparent() const { return transmission.x > 0.0f || transmission.y > 0.0f || transmission.z > 0.0f; }
};

}  // namespace plumb

// The one material model: glTF's metallic-roughness with alpha mask and emission.
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
    glm::vec3 emission{0.0f};                     // radiance in W / (m^2 sr), linear; leaves both sides where two_sided
    int emission_texture = no_texture;
    bool alpha_mask = false;  // surface exists only where alpha >= alpha_cutoff
    float alpha_cutoff = 0.5f;
    int alpha_texture = no_texture;  // separate mask; no_texture: alpha of the base colour texture
    int alpha_channel = 3;           // channel of alpha_texture that holds the mask
    bool two_sided = true;           // false: the surface neither reflects nor emits on its back, where it is black

    bool is_emissive() const { return emission.x > 0.0f || emission.y > 0.0f || emission.z > 0.0f; }
};

}  // namespace plumb

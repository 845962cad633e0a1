// How shaders read the textures of radiance_maps.h.

const int prefiltered_levels = 6;

// Irradiance on a surface of unit normal n.
vec3 diffuse_irradiance(samplerCube irradiance, vec3 n) { return textureLod(irradiance, n, 0.0).rgb; }

// Radiance through a lobe of `roughness` about `direction`, to be multiplied with f0 A + f90 B.
vec3 glossy_radiance(samplerCube prefiltered, vec3 direction, float roughness) {
    return textureLod(prefiltered, direction, roughness * float(prefiltered_levels - 1)).rgb;
}

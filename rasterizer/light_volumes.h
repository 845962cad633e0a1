// Where point and spot lights matter, as meshes: a sphere, or for a spot light a cone, of the radius at which the light
// falls below a threshold.
//
//     strongest channel of the intensity / (constant + linear d + quadratic d^2) = threshold
//
// solved for d. The threshold is an irradiance (W / m^2, on a surface that faces the light). What is left out is less
// than albedo / pi * threshold of radiance per light; where n lights are left out, less than n times that.
//   Source: Meiri, "OGLdev", tutorial 36, with 1/256 as the threshold: half a step of an 8-bit picture. A light of pure
//   inverse square, which that attenuation has no name for, is the case constant = linear = 0.
// The tutorial's code solves with the quadratic term in the place of the constant one, which makes volumes larger where
// the constant is the larger of the two, and smaller where it is the smaller: then more light is lost than the
// threshold allows. So does VolumeRadius::ogldev_code; without a quadratic term, by which that code divides, the radius
// is infinite. A light that never falls below the threshold reaches to the scene's farthest corner, beyond which
// nothing is lit.
//
// The meshes contain the true sphere and cone wholly, so that corners between their facets lose no light.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "rasterizer/method.h"
#include "scenes/scene.h"

namespace plumb {

// The distance at which `strongest` W / sr fall below `threshold` W / m^2; infinity where they never do, 0 where they
// are below it everywhere.
float light_radius(const Attenuation& attenuation, float strongest, float threshold,
                   VolumeRadius defined_by = VolumeRadius::attenuation);

// One light's volume. `light` is its index among the scene's point or spot lights.
struct LightVolume {
    glm::mat4 world_from_unit{1.0f};
    std::int32_t light = 0;
};

struct LightVolumes {
    LightVolumes(const Scene& scene, float threshold, VolumeRadius defined_by = VolumeRadius::attenuation);

    std::vector<LightVolume> point_spheres;
    std::vector<LightVolume> spot_spheres;  // cones wider than a flat shadow map can be
    std::vector<LightVolume> spot_cones;
};

// Triangles, counter-clockwise seen from outside.
struct VolumeMesh {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices;
};
// Contains the unit sphere: an icosahedron, each face cut in four `subdivisions` times, scaled until its facets touch.
VolumeMesh enclosing_sphere(int subdivisions);
// Contains the cone from the origin along -z to z = -1, whose radius there is 1.
VolumeMesh enclosing_cone(int sides);

// World space box of a mesh that lies within [-1, 1]^3 times `extent`.
Bounds volume_bounds(const LightVolume& volume, float extent);

}  // namespace plumb

// Irradiance of ambient light on a surface; ambient_light.h says where it comes from.
//
// Defines: AMBIENT_RADIANCE (constant) or AMBIENT_CUBE_UNIT (the texture unit of a cube of irradiance).

#ifdef AMBIENT_CUBE_UNIT
#include "radiance_maps.glsl"
layout(binding = AMBIENT_CUBE_UNIT) uniform samplerCube ambient_cube;

vec3 ambient_irradiance(vec3 normal) { return diffuse_irradiance(ambient_cube, normal); }
#else
vec3 ambient_irradiance(vec3 normal) { return vec3(3.14159265 * AMBIENT_RADIANCE); }
#endif

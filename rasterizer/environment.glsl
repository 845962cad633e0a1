// Radiance that arrives from infinitely far away: the counterpart of Scene::environment_radiance.
//
// Defines: ENVIRONMENT_TEXTURE_UNIT where the environment has an equirectangular texture.

uniform vec3 environment_tint;  // W / (m^2 sr)
#ifdef ENVIRONMENT_TEXTURE_UNIT
layout(binding = ENVIRONMENT_TEXTURE_UNIT) uniform sampler2D environment_texture;
uniform float environment_rotation;  // radians about +Y
#endif

vec3 environment_radiance(vec3 direction) {
#ifdef ENVIRONMENT_TEXTURE_UNIT
    const float pi = 3.14159265358979;
    float longitude = atan(direction.x, -direction.z) + environment_rotation;
    vec2 uv = vec2(fract(0.5 + longitude / (2.0 * pi)), acos(clamp(direction.y, -1.0, 1.0)) / pi);
    return environment_tint * textureLod(environment_texture, uv, 0.0).rgb;
#else
    return environment_tint;
#endif
}

// The specular lobe of scenes/ggx.h in GLSL; `alpha` as ggx_alpha() gives it: 0 for a mirror.

// Of a perceptual roughness.
float ggx_alpha(float roughness) {
    float alpha = roughness * roughness;
    return alpha < 1e-3 ? 0.0 : min(alpha, 1.0);
}

float ggx_distribution(float cosine_h, float squared_sine_h, float alpha) {
    float a2 = alpha * alpha;
    float t = squared_sine_h + a2 * cosine_h * cosine_h;
    return a2 / (3.14159265358979 * t * t);
}

float smith_root(float cosine, float alpha) {
    float a2 = alpha * alpha;
    return sqrt(a2 + (1.0 - a2) * cosine * cosine);
}

float schlick_weight(float cosine) {
    float x = clamp(1.0 - cosine, 0.0, 1.0);
    return x * x * x * x * x;
}

vec3 schlick_fresnel(vec3 f0, float f90, float cosine) { return f0 + (vec3(f90) - f0) * schlick_weight(cosine); }

// Turned until the viewer lies on the horizon, where it lies below.
vec3 lobe_normal(vec3 shading_normal, vec3 to_viewer) {
    float cosine = dot(shading_normal, to_viewer);
    return cosine >= 0.0 ? shading_normal : normalize(shading_normal - cosine * to_viewer);
}

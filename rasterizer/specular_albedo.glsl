// SpecularAlbedo::split in GLSL: (A, B) such that a lobe reflects f0 A + f90 B of what comes from its directions.
//
// Defines: SPECULAR_ALBEDO_UNIT.

layout(binding = SPECULAR_ALBEDO_UNIT) uniform sampler2D specular_albedo_table;

// `alpha` as ggx_alpha() gives it: 0 for a mirror.
vec2 specular_split(float cosine_o, float alpha) {
    if (alpha == 0.0) {
        float x = clamp(1.0 - cosine_o, 0.0, 1.0);
        float share = x * x * x * x * x;
        return vec2(1.0 - share, share);
    }
    float scale = alpha / (1.0 + 8.0 * alpha);
    float column = log((cosine_o + sqrt(cosine_o * cosine_o + scale * scale)) / scale) /
                   log((1.0 + sqrt(1.0 + scale * scale)) / scale);
    const float smallest_root = 0.17782794;  // of the smallest alpha, to the power of 1/4
    float row = (sqrt(sqrt(alpha)) - smallest_root) / (1.0 - smallest_root);
    vec2 size = vec2(textureSize(specular_albedo_table, 0));
    return textureLod(specular_albedo_table, (clamp(vec2(column, row), 0.0, 1.0) * (size - 1.0) + 0.5) / size, 0.0).rg;
}

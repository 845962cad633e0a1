// Unit vectors as two numbers in [0, 1]: the octahedral map. 16 bits each keep a direction to about 0.003 degrees.
//   Source: Cigolla, Donow, Evangelakos, Mara, McGuire, Meyer 2014, "A Survey of Efficient Representations for
//   Independent Unit Vectors", JCGT 3(2). The C++ counterpart is decode_normal in normal_encoding.h.

vec2 encode_normal(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0) p = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return 0.5 * p + 0.5;
}

vec3 decode_normal(vec2 encoded) {
    vec2 p = 2.0 * encoded - 1.0;
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    float fold = max(-n.z, 0.0);
    n.xy += vec2(n.x >= 0.0 ? -fold : fold, n.y >= 0.0 ? -fold : fold);
    return normalize(n);
}

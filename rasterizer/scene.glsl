// One instance and its material, as SceneGeometry fills them.
layout(std140, binding = 1) uniform InstanceBlock {
    mat4 world_from_object;
    mat3 world_normal_from_object;
    vec4 base_colour_and_metallic;
    vec4 emission_and_roughness;
    float alpha_cutoff;
    int alpha_channel;
    int two_sided;
    float dielectric_reflectance;
    mat4 previous_world_from_object;  // in the frame before
    mat4 next_world_from_object;      // in the frame to come
    // Takes normals of now to where they pointed in the frame before, in the columns' xyz. w of the first: 1 where the
    // instance has turned or changed its shape since, else 0.
    vec4 previous_normal_from_normal[3];
};

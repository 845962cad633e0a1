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
    mat4 next_world_from_object;  // in the frame to come
    uint moving_number;           // among the instances that move, from 1 (instance_motion.h); 0: it stands still
};

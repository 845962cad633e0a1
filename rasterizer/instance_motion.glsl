// How an instance has moved since the frame before, by its number in the plane `moving_instance` (gbuffer_planes.h): 0 is
// what stands still, and most of a picture, so that nothing is read for it. InstanceMotions (instance_motion.h) fills it.
struct InstanceMotion {
    // Of a point of now, in the camera space of now: where it was minus where it is, metres. Its three rows.
    vec4 displacement[3];
    mat3 previous_normal_from_normal;  // world space; lengths are lost
};
layout(std430, binding = 6) readonly buffer InstanceMotionBlock { InstanceMotion instance_motions[]; };

vec3 displacement_of(uint instance, vec3 point) {
    if (instance == 0u) return vec3(0.0);
    vec4 p = vec4(point, 1.0);
    return vec3(dot(instance_motions[instance].displacement[0], p), dot(instance_motions[instance].displacement[1], p),
                dot(instance_motions[instance].displacement[2], p));
}

vec3 previous_normal_of(uint instance, vec3 normal) {
    if (instance == 0u) return normal;
    return normalize(instance_motions[instance].previous_normal_from_normal * normal);
}

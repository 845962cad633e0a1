// How an instance has moved since the frame before, by its number in the plane `moving_instance` (gbuffer_planes.h).
// InstanceMotions (instance_motion.h) fills it.
struct InstanceMotion {
    // Of a point of now, in the camera space of now: where it was minus where it is, metres. The fourth row is 0.
    mat4 displacement;
    mat3 previous_normal_from_normal;  // world space; lengths are lost
};
layout(std430, binding = 6) readonly buffer InstanceMotionBlock { InstanceMotion instance_motions[]; };

vec3 displacement_of(uint instance, vec3 point) {
    return (instance_motions[instance].displacement * vec4(point, 1.0)).xyz;
}

vec3 previous_normal_of(uint instance, vec3 normal) {
    return normalize(instance_motions[instance].previous_normal_from_normal * normal);
}

// What the triangles of calibrating_workload.vert write. Changing it: see there.

in vec3 normal;
in float height;

layout(location = 0) out vec4 surface;  // normal, height

void main() { surface = vec4(normalize(normal), height); }

// A fixed field of bumps as small triangles: calibrating_workload.h. No buffer is read, so that the work is the same
// everywhere. Changing a letter here changes what every calibrated cost is told by: see calibrating_workload_version.

out vec3 normal;
out float height;

// Two triangles a cell.
const ivec2 corners[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 0), ivec2(1, 1), ivec2(0, 1));

float bumps(vec2 p) { return 0.25 * sin(9.0 * p.x) * cos(7.0 * p.y) + 0.1 * sin(31.0 * p.x + 23.0 * p.y); }

void main() {
    int cell = gl_VertexID / 6;
    vec2 p = vec2(ivec2(cell % CELLS, cell / CELLS) + corners[gl_VertexID % 6]) / float(CELLS);
    height = bumps(p);
    normal = normalize(vec3(bumps(p + vec2(1e-3, 0.0)) - height, bumps(p + vec2(0.0, 1e-3)) - height, 1e-3));
    // Tilted, so that the bumps hide one another and the depth test has something to do.
    gl_Position = vec4(2.0 * p.x - 1.0, 1.4 * p.y - 0.7 + height, 0.3 + 0.4 * (p.y - height), 1.0);
}

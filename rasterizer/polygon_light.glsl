// Irradiance from a polygon of constant radiance, and from a small disc.
//
//   Source: Lambert 1760, as in Baum, Rushmeier, Winget 1989, "Improving Radiosity Solutions Through the Use of
//   Analytically Determined Form-Factors": E = L/2 sum over edges of (angle of the edge) * (n . unit normal of the
//   edge's plane through the receiver), for a polygon wholly above the receiver's horizon.

// The edge from p to q, both relative to the receiver.
float edge_term(vec3 p, vec3 q, vec3 n) {
    vec3 normal = cross(p, q);
    float size = length(normal);
    if (size == 0.0) return 0.0;
    return atan(size, dot(p, q)) * dot(n, normal) / size;
}

// Irradiance per radiance at the origin from triangle abc, clipped at the horizon. Both sides of it shine alike.
float triangle_irradiance(vec3 a, vec3 b, vec3 c, vec3 n) {
    vec3 corners[4] = vec3[](a, b, c, a);
    float sum = 0.0;
    vec3 leaves = vec3(0.0), enters = vec3(0.0);  // where the outline crosses the horizon
    bool crosses = false;
    for (int i = 0; i < 3; ++i) {
        vec3 p = corners[i], q = corners[i + 1];
        float above_p = dot(n, p), above_q = dot(n, q);
        if (above_p <= 0.0 && above_q <= 0.0) continue;
        if (above_q <= 0.0) {
            q = leaves = mix(p, q, above_p / (above_p - above_q));
            crosses = true;
        } else if (above_p <= 0.0) {
            p = enters = mix(p, q, above_p / (above_p - above_q));
            crosses = true;
        }
        sum += edge_term(p, q, n);
    }
    if (crosses) sum += edge_term(leaves, enters, n);
    return 0.5 * abs(sum);
}

// The same from a disc far enough away: `vector_area` points to its front; `to_disc` to its centre.
//   Source: the form factor of a point to a parallel disc, with the cosines of Wallace, Elmquist, Haines 1989.
float disc_irradiance(vec3 to_disc, vec3 vector_area, vec3 n, bool both_sides) {
    float square = dot(to_disc, to_disc);
    vec3 direction = to_disc * inversesqrt(max(square, 1e-20));
    float facing = -dot(vector_area, direction);
    facing = both_sides ? abs(facing) : max(facing, 0.0);
    return max(dot(n, direction), 0.0) * facing / (square + length(vector_area) / 3.14159265);
}

// How the vertices of paths are connected with lights; how paths go on stands in path_integrator.cpp.
#include <algorithm>

#include <glm/gtc/constants.hpp>

#include "pathtracer/path_dimensions.h"
#include "pathtracer/path_integrator.h"

namespace plumb {

// Adds to `sum` what reaches each vertex from one sampled light with an extent and from one without.
PLUMBLINE_FOR_EACH_MACHINE
void PathIntegrator::next_event(const VertexBatch& vertices, int vertex, Start start, PathWorkspace& workspace,
                                VectorLanes& sum, int& rays) const {
    const bool specular_start = start == Start::specular;
    LightLanes& lights = workspace.lights;
    if (lights_.has_extended_lights()) {
        Lanes<std::uint32_t> x;
        Lanes<float> y;
        sample_points(vertices.samples, vertices.count,
                      path_dimension(vertex, specular_start, VertexUse::extended_light), x, y);
        lights_.sample_extended(vertices, x, y, lights);
        connect(vertices, vertex, start, workspace, sum, rays);
    }
    const bool exact_already = vertex == 0 && !specular_start && plan_.exact_lights_at_first_point;
    if (lights_.lights_without_extent() > 0 && !exact_already) {
        Lanes<float> pick;
        sample_numbers(vertices.samples, vertices.count, path_dimension(vertex, specular_start, VertexUse::other_light),
                       pick);
        lights_.sample_without_extent(vertices, pick, lights);
        connect(vertices, vertex, start, workspace, sum, rays);
    }
}

// A bulge that reaches into or through another surface would let light in that the surface keeps out.
void PathIntegrator::close_hidden_bulges(const VertexBatch& vertices, const Lanes<float>& rise, ShadowRays& to_bulges,
                                         Lanes<float>& open, int& rays) const {
    if (!scene_.anything_bulges()) return;
    to_bulges.rays.count = 0;
    for (int i = 0; i < vertices.count; ++i) {
        if (!(rise[i] > 0.0f && open[i] > 0.0f)) continue;
        to_bulges.add(i, vertices.ray_origin.get(i), vertices.shading_normal.get(i), rise[i], vertices.time[i]);
    }
    const int count = to_bulges.rays.count;
    if (count == 0) return;
    rays += count;
    Lanes<int> blocked;
    scene_.occluded(to_bulges.rays, blocked);
    for (int i = 0; i < count; ++i) {
        if (blocked[i]) open[to_bulges.vertex[i]] = 0.0f;
    }
}

// Adds to `sum` what each vertex makes of its sample in `workspace.lights`, where the way to the light is open.
PLUMBLINE_FOR_EACH_MACHINE
void PathIntegrator::connect(const VertexBatch& vertices, int vertex, Start start, PathWorkspace& workspace,
                             VectorLanes& sum, int& rays) const {
    const LightLanes& lights = workspace.lights;
    ShadowRays& shadow = workspace.shadow;
    const bool leaves_diffusely = vertex == 0 && start == Start::diffuse;
    const float others_compete = lights_.rays_find_emitters() ? 1.0f : 0.0f;
    VectorLanes brought;
    Lanes<float> brings;
    for (int i = 0; i < whole_groups(vertices.count); ++i) {
        const glm::vec3 direction = lights.direction.get(i);
        // Light from behind the triangle is stopped by the triangle itself, whatever the interpolated normal says, but
        // for where the triangle stands for a surface that bulges.
        const float cosine = std::max(0.0f, glm::dot(vertices.shading_normal.get(i), direction));
        const bool is_above = glm::dot(vertices.geometric_normal.get(i), direction) > 0.0f;
        const float open = is_above || lights.rise[i] > 0.0f ? 1.0f : 0.0f;
        const float density = cosine * glm::one_over_pi<float>();
        // A light that nothing else finds has no density, and then the weight is 1.
        const float other = lights.density[i] > 0.0f ? others_compete * density / lights.density[i] : 0.0f;
        const float scale = open * density / (1.0f + other * other);
        const glm::vec3 albedo = leaves_diffusely ? glm::vec3(1.0f) : vertices.albedo.get(i);
        const glm::vec3 light = vertices.throughput.get(i) * albedo * lights.radiance.get(i) * scale;
        brought.set(i, light);
        brings[i] = light.x + light.y + light.z;
    }
    for (int i = 0; i < vertices.count && !leaves_diffusely && !vertices.all_plain; ++i) {
        if (vertices.is_plain[i]) continue;
        const glm::vec3 direction = lights.direction.get(i);
        const SpecularLobeValue value = scattering(vertices, i, vertex).evaluate(direction);
        const bool competes = others_compete > 0.0f && lights.density[i] > 0.0f;
        const float weight = competes ? power_heuristic(lights.density[i], value.density) : 1.0f;
        const bool open = glm::dot(vertices.geometric_normal.get(i), direction) > 0.0f || lights.rise[i] > 0.0f;
        float scale = open ? weight : 0.0f;
        if (start == Start::specular && is_limited(start, vertex)) {
            scale *= counted(start, lights.farthest[i] * glm::length(lights.shadow_ray.get(i)));
        }
        brought.set(i, vertices.throughput.get(i) * value.reflected * lights.radiance.get(i) * scale);
        brings[i] = brought.x[i] + brought.y[i] + brought.z[i];
    }
    close_hidden_bulges(vertices, lights.rise, workspace.to_bulges, brings, rays);
    // Whether light arrives at all is anybody's guess, also the processor's: each ray is set, and the next one takes
    // its place where it brings nothing.
    RayBatch& shadow_rays = shadow.rays;
    int count = 0;
    for (int i = 0; i < vertices.count; ++i) {
        shadow.vertex[count] = i;
        shadow_rays.set(count, vertices.origin(i, lights.rise[i]), lights.shadow_ray.get(i), lights.farthest[i],
                        vertices.time[i]);
        count += brings[i] > 0.0f ? 1 : 0;
    }
    shadow_rays.count = count;
    rays += count;
    VectorLanes passing;
    scene_.transmittance(shadow_rays, passing);
    for (int i = 0; i < count; ++i) {
        const int lane = shadow.vertex[i];
        sum.add(vertices.path[lane], brought.get(lane) * passing.get(i));
    }
}

glm::vec3 PathIntegrator::exact_direct(const SurfacePoint& x, std::uint64_t& rays) const {
    LightReceiver receiver{x.ray_origin, x.shading_normal, x.shading_normal, x.geometric_normal, x.bulge, now};
    if (x.bulge > 0.0f && lights_.lights_without_extent() > 0) {
        RayBatch to_bulge;
        Lanes<int> blocked;
        to_bulge.add(x.ray_origin, x.shading_normal, x.bulge, now);
        scene_.occluded(to_bulge, blocked);
        ++rays;
        if (blocked[0]) receiver.bulge = 0.0f;
    }
    glm::vec3 sum(0.0f);
    for (std::size_t first = 0; first < lights_.lights_without_extent(); first += most_lanes) {
        RayBatch shadow_rays;
        VectorLanes light, passing;
        const std::size_t end = std::min(first + most_lanes, lights_.lights_without_extent());
        for (std::size_t i = first; i < end; ++i) {
            const LightSample sample = lights_.light_without_extent(i, receiver);
            const float cosine = glm::dot(x.shading_normal, sample.direction);
            const bool is_open = glm::dot(x.geometric_normal, sample.direction) > 0.0f || sample.rise > 0.0f;
            if (sample.radiance == glm::vec3(0.0f) || cosine <= 0.0f || !is_open) continue;
            light.set(shadow_rays.count, sample.radiance * (cosine * glm::one_over_pi<float>()));
            shadow_rays.add(x.ray_origin + sample.rise * x.shading_normal, sample.shadow_ray, sample.farthest, now);
        }
        rays += static_cast<std::uint64_t>(shadow_rays.count);
        scene_.transmittance(shadow_rays, passing);
        for (int i = 0; i < shadow_rays.count; ++i) sum += light.get(i) * passing.get(i);
    }
    return sum;
}

}  // namespace plumb

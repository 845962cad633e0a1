#include "pathtracer/path_integrator.h"

#include <algorithm>

#include <glm/gtc/constants.hpp>

#include "pathtracer/direction_sampling.h"

namespace plumb {
namespace {

// Dimensions of the sequence that vertex k uses; 0 is the pixel's.
constexpr std::uint32_t dimensions_per_vertex = 4;
constexpr std::uint32_t first_dimension(int vertex) {
    return 1 + dimensions_per_vertex * static_cast<std::uint32_t>(vertex);
}
constexpr std::uint32_t extended_pick = 0, extended_point = 1, other_pick = 2, next_direction = 3;

}  // namespace

// The radiance that a white Lambertian surface at `point` reflects of one light sample.
glm::vec3 PathIntegrator::reflected(const SurfacePoint& point, const LightSample& light, int& rays) const {
    const float cosine = glm::dot(point.shading_normal, light.direction);
    // Light from behind the triangle is stopped by the triangle itself, whatever the interpolated normal says.
    if (light.radiance == glm::vec3(0.0f) || cosine <= 0.0f ||
        glm::dot(point.geometric_normal, light.direction) <= 0.0f) {
        return glm::vec3(0.0f);
    }
    const glm::vec3 origin = point.ray_origin();
    ++rays;
    const bool shadowed = light.infinitely_far ? scene_.occluded(origin, light.direction)
                                               : scene_.occluded(origin, light.end - origin, 1.0f);
    if (shadowed) return glm::vec3(0.0f);
    const float pdf_of_ray = cosine * glm::one_over_pi<float>();
    const bool rays_compete = light.density > 0.0f && lights_.rays_find_emitters();
    return light.radiance * (pdf_of_ray * (rays_compete ? power_heuristic(light.density, pdf_of_ray) : 1.0f));
}

glm::vec3 PathIntegrator::next_event(const SurfacePoint& point, int vertex, const SampleSequence& sequence,
                                     int& rays) const {
    const std::uint32_t dimension = first_dimension(vertex);
    glm::vec3 sum(0.0f);
    if (lights_.has_extended_lights()) {
        const LightSample light =
            lights_.sample_extended(point.position, point.shading_normal, sequence.number(dimension + extended_pick),
                                    sequence.point(dimension + extended_point));
        sum += reflected(point, light, rays);
    }
    const bool exact_already = vertex == 0 && plan_.exact_lights_at_first_point;
    if (lights_.lights_without_extent() > 0 && !exact_already) {
        const LightSample light = lights_.sample_without_extent(point.position, point.shading_normal,
                                                                sequence.number(dimension + other_pick));
        sum += reflected(point, light, rays);
    }
    return sum;
}

glm::vec3 PathIntegrator::exact_direct(const SurfacePoint& x, std::uint64_t& rays) const {
    glm::vec3 sum(0.0f);
    int traced = 0;
    for (std::size_t i = 0; i < lights_.lights_without_extent(); ++i) {
        sum += reflected(x, lights_.light_without_extent(i, x.position), traced);
    }
    rays += static_cast<std::uint64_t>(traced);
    return x.albedo * sum;
}

int PathIntegrator::estimate(const SurfacePoint& x, const SampleSequence& sequence, PathEstimate& estimate) const {
    int rays = 0;
    estimate.ambient_visibility = 1.0f;
    std::fill_n(estimate.radiance.begin(), plan_.bounces + 1, glm::vec3(0.0f));

    // Nothing that x receives matters where x is black, unless the irradiance itself is wanted.
    const bool lit = x.albedo != glm::vec3(0.0f) || plan_.irradiance;
    const bool indirect = plan_.indirect && lit, direct = plan_.direct && lit;

    SurfacePoint vertex = x;
    glm::vec3 throughput(1.0f);
    for (int k = 0; k <= plan_.bounces; ++k) {
        const bool gathers = k == 0 ? direct : indirect;
        if (gathers) estimate.radiance[k] += throughput * next_event(vertex, k, sequence, rays);

        const bool looks_for_emitters = gathers && lights_.rays_find_emitters();
        const bool goes_on = indirect && k < plan_.bounces;
        const bool tests_visibility = plan_.ao && k == 0;
        if (!looks_for_emitters && !goes_on && !tests_visibility) break;

        const glm::vec3 direction =
            sample_cosine_hemisphere(vertex.shading_normal, sequence.point(first_dimension(k) + next_direction));
        if (glm::dot(vertex.geometric_normal, direction) <= 0.0f) {  // into the triangle itself
            if (tests_visibility) estimate.ambient_visibility = 1.0f - obscurance(0.0f);
            break;
        }
        float reach = infinite_distance;
        if (!looks_for_emitters && k == 0) {
            reach = std::max(goes_on ? plan_.indirect_radius : 0.0f, tests_visibility ? plan_.ao_radius : 0.0f);
        }
        const glm::vec3 origin = vertex.ray_origin();
        ++rays;
        // Where only the fact of a hit matters, the cheaper query does.
        const bool any_hit_serves = !goes_on && !(looks_for_emitters && lights_.rays_find_triangles()) &&
                                    !(tests_visibility && (looks_for_emitters || plan_.ao_falloff != Falloff::hard));
        if (any_hit_serves) {
            const bool hit = scene_.occluded(origin, direction, reach);
            if (tests_visibility && hit) estimate.ambient_visibility = 1.0f - obscurance(0.0f);
            if (looks_for_emitters && !hit) {
                estimate.radiance[k] +=
                    throughput * lights_.weighted_environment(direction, glm::dot(vertex.shading_normal, direction));
            }
            break;
        }
        const SurfaceHit hit = scene_.intersect(origin, direction, positive_distance, reach);
        if (tests_visibility && !hit.missed()) estimate.ambient_visibility = 1.0f - obscurance(hit.distance);
        if (!looks_for_emitters && !goes_on) break;
        const float cosine = glm::dot(vertex.shading_normal, direction);
        if (hit.missed()) {
            if (looks_for_emitters) {
                estimate.radiance[k] += throughput * lights_.weighted_environment(direction, cosine);
            }
            break;
        }
        const SurfacePoint next = scene_.surface_point(hit, direction);
        if (looks_for_emitters) {
            estimate.radiance[k] += throughput * lights_.weighted_emission(hit, next, direction, cosine);
        }
        throughput *= next.albedo;
        if (!goes_on || throughput == glm::vec3(0.0f)) break;
        if (k == 0 && hit.distance >= plan_.indirect_radius) break;
        vertex = next;
    }
    return rays;
}

}  // namespace plumb

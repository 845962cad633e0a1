#include "pathtracer/path_integrator.h"

#include <algorithm>

#include <glm/gtc/constants.hpp>

#include "pathtracer/direction_sampling.h"

namespace plumb {
namespace {

// Dimensions of the sequence that vertex k uses; the first ones choose the primary ray. Paths that start with the
// specular lobe have their own.
enum Use : std::uint32_t { extended_pick, extended_point, other_pick, next_direction, lobe_pick, roulette, pane_pick };
constexpr std::uint32_t uses_per_vertex = 8, primary_uses = 4, specular_paths = 1u << 16, panes_apart = 1u << 20;
constexpr std::uint32_t dimension(int vertex, bool from_specular_start, Use use) {
    return primary_uses + uses_per_vertex * static_cast<std::uint32_t>(vertex) + use +
           (from_specular_start ? specular_paths : 0u);
}

void add_to(VectorLanes& sum, int lane, const glm::vec3& value) {
    sum.x[lane] += value.x, sum.y[lane] += value.y, sum.z[lane] += value.z;
}

float largest(const glm::vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }

void clear(VectorLanes& lanes, int count) {
    std::fill_n(lanes.x.begin(), count, 0.0f);
    std::fill_n(lanes.y.begin(), count, 0.0f);
    std::fill_n(lanes.z.begin(), count, 0.0f);
}

}  // namespace

// The rays with which paths leave their vertices, one beside the other.
struct PathIntegrator::ScatteredRays {
    RayBatch rays;
    Lanes<int> vertex;     // lane of the vertex that each leaves
    VectorLanes weight;    // BSDF times cosine over density
    Lanes<float> density;  // per solid angle; 0: nothing else finds this direction
    Lanes<int> ended;      // lanes whose direction led into their own surface
    int ended_count = 0;

    void add(int lane, const glm::vec3& origin, const glm::vec3& direction, float reach, float time,
             const glm::vec3& with_weight, float with_density) {
        vertex[rays.count] = lane, density[rays.count] = with_density;
        weight.set(rays.count, with_weight);
        rays.add(origin, direction, reach, time);
    }
};

glm::vec3 PathIntegrator::add_start(const SurfacePoint& x, const glm::vec3& direction, const SampleIndex& sample,
                                    float time, VertexBatch& batch) const {
    const int lane = batch.count++;
    batch.path[lane] = lane;
    batch.samples.set(lane, sample);
    batch.time[lane] = time;
    batch.ray_origin.set(lane, x.ray_origin);
    batch.geometric_normal.set(lane, x.geometric_normal);
    batch.shading_normal.set(lane, x.shading_normal);
    batch.throughput.set(lane, glm::vec3(1.0f));
    batch.is_plain[lane] = !x.specular.has_lobe() && !x.specular.is_transparent();
    glm::vec3 albedo = x.albedo;
    if (!batch.is_plain[lane]) {
        batch.specular[lane] = {x.specular, -direction, 2.0f * x.position - x.ray_origin};
        albedo *= 1.0f - specular_albedo(x.specular, x.shading_normal, -direction);
    }
    batch.albedo.set(lane, albedo);
    return albedo;
}

glm::vec3 PathIntegrator::specular_albedo(const SpecularSurface& surface, const glm::vec3& shading_normal,
                                          const glm::vec3& to_viewer) const {
    if (!surface.has_lobe()) return glm::vec3(0.0f);
    const float cosine = std::max(0.0f, glm::dot(lobe_normal(shading_normal, to_viewer), to_viewer));
    return specular_albedo_->albedo(surface.f0, surface.f90, cosine, surface.alpha);
}

Scattering PathIntegrator::scattering(const VertexBatch& vertices, int lane, int vertex) const {
    const SpecularVertex& here = vertices.specular[lane];
    const glm::vec3 normal = vertices.shading_normal.get(lane);
    const glm::vec3 specular = specular_albedo(here.surface, normal, here.to_viewer);
    if (vertex > 0) return {here, normal, vertices.albedo.get(lane), specular, glm::vec3(0.0f)};
    return {here, normal, glm::vec3(0.0f), specular, here.surface.transmission};
}

// Adds to `sum` the light that shadow rays find open; the i-th leaves vertex lanes[i] and would bring light.get(i).
void PathIntegrator::connect(const VertexBatch& vertices, const Lanes<int>& lanes, const RayBatch& shadow_rays,
                             const VectorLanes& light, VectorLanes& sum, int& rays) const {
    rays += shadow_rays.count;
    VectorLanes passing;
    scene_.transmittance(shadow_rays, passing);
    for (int i = 0; i < shadow_rays.count; ++i) {
        add_to(sum, vertices.path[lanes[i]], light.get(i) * passing.get(i));
    }
}

// Adds to `sum` what reaches each vertex from one sampled light with an extent and from one without.
void PathIntegrator::next_event(const VertexBatch& vertices, int vertex, Start start, VectorLanes& sum,
                                int& rays) const {
    const bool rays_compete = lights_.rays_find_emitters();
    const bool specular_start = start == Start::specular;
    const bool leaves_diffusely = vertex == 0 && !specular_start;
    const auto gather = [&](const auto& sample_light) {
        RayBatch shadow_rays;
        VectorLanes light;
        Lanes<int> lanes;
        for (int i = 0; i < vertices.count; ++i) {
            const LightReceiver receiver{vertices.ray_origin.get(i), vertices.shading_normal.get(i), vertices.time[i]};
            const LightSample sample = sample_light(i, receiver);
            const float cosine = glm::dot(receiver.normal, sample.direction);
            // Light from behind the triangle is stopped by the triangle itself, whatever the interpolated normal says.
            if (sample.radiance == glm::vec3(0.0f) ||
                glm::dot(vertices.geometric_normal.get(i), sample.direction) <= 0.0f) {
                continue;
            }
            glm::vec3 reflected;
            float density = std::max(0.0f, cosine) * glm::one_over_pi<float>();
            if (leaves_diffusely) {
                reflected = glm::vec3(density);
            } else if (vertices.is_plain[i]) {
                reflected = density * vertices.albedo.get(i);
            } else {
                const SpecularLobeValue value = scattering(vertices, i, vertex).evaluate(sample.direction);
                reflected = value.reflected, density = value.density;
            }
            if (rays_compete && sample.density > 0.0f) reflected *= power_heuristic(sample.density, density);
            const glm::vec3 brought = vertices.throughput.get(i) * reflected * sample.radiance;
            if (brought == glm::vec3(0.0f)) continue;
            lanes[shadow_rays.count] = i;
            light.set(shadow_rays.count, brought);
            shadow_rays.add(receiver.origin, sample.shadow_ray, sample.farthest, receiver.time);
        }
        if (shadow_rays.count > 0) connect(vertices, lanes, shadow_rays, light, sum, rays);
    };

    if (lights_.has_extended_lights()) {
        Lanes<float> pick, unused, x, y;
        sample_points(vertices.samples, vertices.count, dimension(vertex, specular_start, extended_pick), pick, unused);
        sample_points(vertices.samples, vertices.count, dimension(vertex, specular_start, extended_point), x, y);
        gather([&](int i, const LightReceiver& receiver) {
            return lights_.sample_extended(receiver, pick[i], {x[i], y[i]});
        });
    }
    const bool exact_already = leaves_diffusely && plan_.exact_lights_at_first_point;
    if (lights_.lights_without_extent() > 0 && !exact_already) {
        Lanes<float> pick, unused;
        sample_points(vertices.samples, vertices.count, dimension(vertex, specular_start, other_pick), pick, unused);
        gather([&](int i, const LightReceiver& receiver) { return lights_.sample_without_extent(receiver, pick[i]); });
    }
}

glm::vec3 PathIntegrator::exact_direct(const SurfacePoint& x, std::uint64_t& rays) const {
    glm::vec3 sum(0.0f);
    for (std::size_t first = 0; first < lights_.lights_without_extent(); first += most_lanes) {
        RayBatch shadow_rays;
        VectorLanes light, passing;
        const std::size_t end = std::min(first + most_lanes, lights_.lights_without_extent());
        for (std::size_t i = first; i < end; ++i) {
            const LightSample sample = lights_.light_without_extent(i, x.ray_origin);
            const float cosine = glm::dot(x.shading_normal, sample.direction);
            if (sample.radiance == glm::vec3(0.0f) || cosine <= 0.0f ||
                glm::dot(x.geometric_normal, sample.direction) <= 0.0f) {
                continue;
            }
            light.set(shadow_rays.count, sample.radiance * (cosine * glm::one_over_pi<float>()));
            shadow_rays.add(x.ray_origin, sample.shadow_ray, sample.farthest, now);
        }
        rays += static_cast<std::uint64_t>(shadow_rays.count);
        scene_.transmittance(shadow_rays, passing);
        for (int i = 0; i < shadow_rays.count; ++i) sum += light.get(i) * passing.get(i);
    }
    return sum;
}

// Draws the direction in which each path leaves its vertex.
void PathIntegrator::scatter(const VertexBatch& vertices, int vertex, Start start, ScatteredRays& scattered) const {
    const bool specular_start = start == Start::specular;
    Lanes<float> x, y, density;
    VectorLanes directions;
    sample_points(vertices.samples, vertices.count, dimension(vertex, specular_start, next_direction), x, y);
    for (int i = 0; i < vertices.count; ++i) {
        const glm::vec3 normal = vertices.shading_normal.get(i);
        const glm::vec3 direction = sample_cosine_hemisphere(normal, {x[i], y[i]});
        directions.set(i, direction);
        density[i] = glm::dot(normal, direction) * glm::one_over_pi<float>();
    }
    const bool leaves_diffusely = vertex == 0 && !specular_start;
    for (int i = 0; i < vertices.count; ++i) {
        const glm::vec3 origin = vertices.ray_origin.get(i), normal = vertices.geometric_normal.get(i);
        ScatterSample sample;
        if (leaves_diffusely || vertices.is_plain[i]) {
            sample = {directions.get(i), leaves_diffusely ? glm::vec3(1.0f) : vertices.albedo.get(i), density[i],
                      false};
        } else {
            const SampleIndex index = vertices.samples.get(i);
            const float pick = sobol_point(index, mix_word(dimension(vertex, specular_start, lobe_pick))).x;
            sample = scattering(vertices, i, vertex).sample(pick, {x[i], y[i]});
        }
        if (sample.passes) {
            scattered.add(i, vertices.specular[i].far_side, sample.direction, infinite_distance, vertices.time[i],
                          sample.weight, sample.density);
        } else if (glm::dot(normal, sample.direction) > 0.0f && sample.weight != glm::vec3(0.0f)) {
            scattered.add(i, origin, sample.direction, infinite_distance, vertices.time[i], sample.weight,
                          sample.density);
        } else {
            scattered.ended[scattered.ended_count++] = i;
        }
    }
}

// Lets the rays that met a transparent surface pass it, or not, by chance, until each ends at a surface to be scattered
// at.
void PathIntegrator::pass_panes(const VertexBatch& vertices, int vertex, Start start, ScatteredRays& scattered,
                                HitBatch& hits, int& rays) const {
    for (int i = 0; i < scattered.rays.count; ++i) {
        const glm::vec3 origin = scattered.rays.origin.get(i), direction = scattered.rays.direction.get(i);
        const SampleIndex index = vertices.samples.get(scattered.vertex[i]);
        for (std::uint32_t pane = 0; !hits[i].missed() && !scene_.is_plain(hits[i].instance); ++pane) {
            const SurfacePoint point = scene_.surface_point(hits[i], direction, scattered.rays.time[i]);
            const float passing = largest(point.specular.transmission);
            if (!(passing > 0.0f)) break;
            const float staying =
                largest(point.albedo + specular_albedo(point.specular, point.shading_normal, -direction));
            const float share = passing / (passing + staying);
            const std::uint32_t use = dimension(vertex, start == Start::specular, pane_pick) + pane * panes_apart;
            const glm::vec3 weight = scattered.weight.get(i);
            if (sobol_point(index, mix_word(use)).x >= share) {
                scattered.weight.set(i, weight / (1.0f - share));
                break;
            }
            scattered.weight.set(i, weight * point.specular.transmission / share);
            hits[i] = scene_.intersect(origin, direction, std::nextafter(hits[i].distance, infinite_distance),
                                       scattered.rays.farthest[i], RayCoherence::incoherent, scattered.rays.time[i]);
            ++rays;
        }
    }
}

// Russian roulette: a path goes on with a probability of its throughput, and counts for the ones that did not.
bool PathIntegrator::survives_roulette(const SampleIndex& sample, int vertex, Start start,
                                       glm::vec3& throughput) const {
    if (plan_.roulette_after == 0 || vertex <= plan_.roulette_after) return true;
    const float probability = std::min(1.0f, largest(throughput));
    const std::uint32_t use = dimension(vertex, start == Start::specular, roulette);
    if (sobol_point(sample, mix_word(use)).x >= probability) return false;
    throughput /= probability;
    return true;
}

void PathIntegrator::follow(VertexBatch* vertices, VertexBatch* next, Start start, BatchEstimate& estimate) const {
    const bool diffuse_start = start == Start::diffuse;
    for (int k = 0; vertices->count > 0; ++k, std::swap(vertices, next)) {
        const bool gathers = !diffuse_start || (k == 0 ? plan_.direct : plan_.indirect);
        VectorLanes& sum = diffuse_start ? estimate.radiance[k] : estimate.reflection;
        if (gathers) next_event(*vertices, k, start, sum, estimate.rays);

        // A mirror's rays, and those that pass a pane, find emitters whatever the strategy.
        const bool looks_for_emitters = gathers && (lights_.rays_find_emitters() || scene_.has_delta_lobes());
        const bool goes_on = k < plan_.bounces && (!diffuse_start || plan_.indirect);
        const bool tests_visibility = diffuse_start && k == 0 && plan_.ao;
        if (!looks_for_emitters && !goes_on && !tests_visibility) return;

        ScatteredRays scattered;
        scatter(*vertices, k, start, scattered);
        const RayBatch& rays = scattered.rays;
        if (tests_visibility) {
            for (int i = 0; i < scattered.ended_count; ++i) {
                estimate.ambient_visibility[vertices->path[scattered.ended[i]]] = 1.0f - obscurance(0.0f);
            }
        }
        if (!looks_for_emitters && diffuse_start && k == 0) {
            const float reach =
                std::max(goes_on ? plan_.indirect_radius : 0.0f, tests_visibility ? plan_.ao_radius : 0.0f);
            std::fill_n(scattered.rays.farthest.begin(), rays.count, reach);
        }
        estimate.rays += rays.count;
        const auto path_of = [&](int i) { return vertices->path[scattered.vertex[i]]; };
        const auto gather_background = [&](int i) {
            const glm::vec3 found = lights_.weighted_background(rays.direction.get(i), scattered.density[i]);
            if (found == glm::vec3(0.0f)) return;
            add_to(sum, path_of(i), vertices->throughput.get(scattered.vertex[i]) * scattered.weight.get(i) * found);
        };

        // Where only the fact of a hit matters, the cheaper query does.
        const bool any_hit_serves = !goes_on && diffuse_start && !scene_.has_transparency() &&
                                    !(looks_for_emitters && lights_.rays_find_triangles()) &&
                                    !(looks_for_emitters && scene_.has_delta_lobes()) &&
                                    !(tests_visibility && (looks_for_emitters || plan_.ao_falloff != Falloff::hard));
        if (any_hit_serves) {
            Lanes<std::uint8_t> blocked;
            scene_.occluded(rays, blocked, layers_);
            for (int i = 0; i < rays.count; ++i) {
                if (blocked[i] && tests_visibility) estimate.ambient_visibility[path_of(i)] = 1.0f - obscurance(0.0f);
                if (!blocked[i] && looks_for_emitters) gather_background(i);
            }
            return;
        }
        HitBatch hits;
        scene_.intersect(rays, hits, RayCoherence::incoherent, layers_);
        if (tests_visibility) {
            for (int i = 0; i < rays.count; ++i) {
                if (hits[i].missed()) continue;
                estimate.ambient_visibility[path_of(i)] = 1.0f - obscurance(hits[i].distance);
            }
        }
        if (!looks_for_emitters && !goes_on) return;
        if (scene_.has_transparency()) pass_panes(*vertices, k, start, scattered, hits, estimate.rays);

        Lanes<int> met;
        int met_count = 0;
        for (int i = 0; i < rays.count; ++i) {
            if (!hits[i].missed()) {
                met[met_count++] = i;
            } else if (looks_for_emitters) {
                gather_background(i);
            }
        }
        SurfaceLanes points;
        scene_.surface_points(rays, hits, met, met_count, points);
        next->count = 0;
        for (int j = 0; j < met_count; ++j) {
            const int i = met[j], lane = scattered.vertex[i];
            glm::vec3 throughput = vertices->throughput.get(lane) * scattered.weight.get(i);
            const glm::vec3 emission = points.emission.get(j), direction = rays.direction.get(i);
            if (looks_for_emitters && emission != glm::vec3(0.0f)) {
                const float weight = lights_.emission_weight(hits[i], points.geometric_normal.get(j), direction,
                                                             scattered.density[i], rays.time[i]);
                add_to(sum, path_of(i), throughput * emission * weight);
            }
            if (!goes_on || (diffuse_start && k == 0 && hits[i].distance >= plan_.indirect_radius)) continue;
            const bool plain = scene_.is_plain(hits[i].instance);
            glm::vec3 albedo = points.albedo.get(j);
            if (plain && albedo == glm::vec3(0.0f)) continue;
            if (!survives_roulette(vertices->samples.get(lane), k + 1, start, throughput)) continue;
            const int to = next->count++;
            next->path[to] = vertices->path[lane];
            next->samples.set(to, vertices->samples.get(lane));
            next->time[to] = rays.time[i];
            next->ray_origin.set(to, points.ray_origin.get(j));
            next->geometric_normal.set(to, points.geometric_normal.get(j));
            next->shading_normal.set(to, points.shading_normal.get(j));
            next->throughput.set(to, throughput);
            next->is_plain[to] = plain;
            if (!plain) {
                next->specular[to] = {scene_.specular_surface(hits[i], direction, rays.time[i]), -direction,
                                      glm::vec3(0.0f)};
                albedo *= 1.0f - specular_albedo(next->specular[to].surface, points.shading_normal.get(j), -direction);
            }
            next->albedo.set(to, albedo);
        }
    }
}

void PathIntegrator::estimate(const VertexBatch& starts, BatchEstimate& estimate) const {
    std::fill_n(estimate.ambient_visibility.begin(), starts.count, 1.0f);
    for (int k = 0; k <= plan_.bounces; ++k) clear(estimate.radiance[k], starts.count);
    clear(estimate.reflection, starts.count);
    estimate.rays = 0;

    VertexBatch vertices, spare;
    vertices.count = 0;
    if (plan_.ao || plan_.direct || plan_.indirect) {
        // Nothing that x receives matters where x is black, unless the irradiance or what is near is wanted.
        const bool also_black = plan_.ao || plan_.irradiance;
        for (int i = 0; i < starts.count; ++i) {
            if (also_black || starts.albedo.get(i) != glm::vec3(0.0f)) vertices.add(starts, i);
        }
        follow(&vertices, &spare, Start::diffuse, estimate);
    }
    if (!plan_.reflection) return;
    vertices.count = 0;
    for (int i = 0; i < starts.count; ++i) {
        if (!starts.is_plain[i]) vertices.add(starts, i);
    }
    follow(&vertices, &spare, Start::specular, estimate);
}

}  // namespace plumb

#include "pathtracer/path_integrator.h"

#include <algorithm>

#include <glm/gtc/constants.hpp>

#include "pathtracer/direction_sampling.h"
#include "pathtracer/path_dimensions.h"

namespace plumb {

glm::vec3 PathIntegrator::add_start(const SurfacePoint& x, const glm::vec3& direction, const SampleIndex& sample,
                                    float time, VertexBatch& batch) const {
    const int lane = batch.count++;
    batch.path[lane] = lane;
    batch.each_its_path = true;
    batch.samples.set(lane, sample);
    batch.time[lane] = time;
    batch.ray_origin.set(lane, x.ray_origin);
    batch.geometric_normal.set(lane, x.geometric_normal);
    batch.shading_normal.set(lane, x.shading_normal);
    batch.bulge[lane] = x.bulge;
    batch.throughput.set(lane, glm::vec3(1.0f));
    batch.is_plain[lane] = !x.specular.has_lobe() && !x.specular.is_transparent();
    batch.all_plain &= batch.is_plain[lane] != 0;
    glm::vec3 albedo = x.albedo;
    if (!batch.is_plain[lane]) {
        batch.specular[lane] = {x.specular, -direction, 2.0f * x.position - x.ray_origin};
        albedo *= 1.0f - scene_.specular_albedo(x.specular, x.shading_normal, -direction);
    }
    batch.albedo.set(lane, albedo);
    return albedo;
}

PLUMBLINE_FOR_EACH_MACHINE
void PathIntegrator::start(const RayBatch& rays, const HitBatch& hits, const MetRays& met, const SampleLanes& samples,
                           VertexBatch& starts) const {
    starts.clear();
    starts.count = met.count;
    starts.each_its_path = true;
    scene_.surface_points(rays, hits, met, starts);
    const int end = whole_groups(met.count);
    PLUMBLINE_INDEPENDENT_LANES
    for (int j = 0; j < end; ++j) {
        starts.path[j] = j;
        starts.samples.set(j, samples.get(met.ray[j]));
        starts.time[j] = rays.time[met.ray[j]];
        starts.throughput.set(j, glm::vec3(1.0f));
    }
    add_lobes(rays, hits, met, starts);
}

// Gives the vertices that `met` led to what they scatter with besides their diffuse lobes.
void PathIntegrator::add_lobes(const RayBatch& rays, const HitBatch& hits, const MetRays& met,
                               VertexBatch& vertices) const {
    vertices.is_plain.fill(0, vertices.count, 1);
    for (int j = 0; j < vertices.count && !scene_.all_plain(); ++j) {
        const int i = met.ray[j];
        if (scene_.is_plain(hits.instance[i])) continue;
        vertices.is_plain[j] = 0;
        vertices.all_plain = false;
        const glm::vec3 to_viewer = -rays.direction.get(i);
        const SurfacePoint point = scene_.surface_point(hits.get(i), rays.direction.get(i), rays.time[i]);
        vertices.specular[j] = {point.specular, to_viewer, 2.0f * point.position - point.ray_origin};
        const glm::vec3 specular = scene_.specular_albedo(point.specular, point.shading_normal, to_viewer);
        vertices.albedo.set(j, vertices.albedo.get(j) * (1.0f - specular));
    }
}

Scattering PathIntegrator::scattering(const VertexBatch& vertices, int lane, int vertex) const {
    const SpecularVertex& here = vertices.specular[lane];
    const glm::vec3 normal = vertices.shading_normal.get(lane);
    const glm::vec3 specular = scene_.specular_albedo(here.surface, normal, here.to_viewer);
    if (vertex > 0) return {here, normal, vertices.albedo.get(lane), specular, glm::vec3(0.0f)};
    return {here, normal, glm::vec3(0.0f), specular, here.surface.transmission * (1.0f - specular)};
}

float PathIntegrator::counted(Start start, float distance) const {
    return start == Start::diffuse ? evaluate_falloff(plan_.indirect_falloff, distance, plan_.indirect_radius)
                                   : evaluate_falloff(plan_.reflection_falloff, distance, plan_.reflection_radius);
}

// Draws the direction in which each path leaves its vertex, with what it counts; weight 0: it does not.
PLUMBLINE_FOR_EACH_MACHINE
void PathIntegrator::draw_directions(const VertexBatch& vertices, int vertex, Start start, ScatteredRays& scattered,
                                     Lanes<std::uint8_t>& passes) const {
    const bool specular_start = start == Start::specular, leaves_diffusely = vertex == 0 && !specular_start;
    Lanes<float> x, y;
    sample_points(vertices.samples, vertices.count, path_dimension(vertex, specular_start, VertexUse::next_direction),
                  x, y);
    const int count = vertices.count;
    for (int i = 0; i < whole_groups(count); ++i) {
        const glm::vec3 normal = vertices.shading_normal.get(i);
        const glm::vec3 direction = sample_cosine_hemisphere(normal, {x[i], y[i]});
        scattered.rays.direction.set(i, direction);
        scattered.density[i] = glm::dot(normal, direction) * glm::one_over_pi<float>();
    }
    passes.fill(0, count, 0);
    if (leaves_diffusely) {
        scattered.weight.fill(0, count, glm::vec3(1.0f));
    } else {
        for (int i = 0; i < whole_groups(count); ++i) scattered.weight.set(i, vertices.albedo.get(i));
    }
    for (int i = 0; i < count && !leaves_diffusely && !vertices.all_plain; ++i) {
        if (vertices.is_plain[i]) continue;
        const SampleIndex index = vertices.samples.get(i);
        const float pick = sobol_point(index, mix_word(path_dimension(vertex, specular_start, VertexUse::lobe_pick))).x;
        const ScatterSample sample = scattering(vertices, i, vertex).sample(pick, {x[i], y[i]});
        scattered.rays.direction.set(i, sample.direction);
        scattered.weight.set(i, sample.weight);
        scattered.density[i] = sample.density;
        passes[i] = sample.passes ? 1 : 0;
    }
}

// Sends each path on its way.
PLUMBLINE_FOR_EACH_MACHINE
void PathIntegrator::scatter(const VertexBatch& vertices, int vertex, Start start, PathWorkspace& workspace,
                             int& ray_count) const {
    ScatteredRays& scattered = workspace.scattered;
    RayBatch& rays = scattered.rays;
    Lanes<std::uint8_t> passes;
    draw_directions(vertices, vertex, start, scattered, passes);
    Lanes<float> leaves, rise;
    const int count = vertices.count, end = whole_groups(count);
    PLUMBLINE_INDEPENDENT_LANES
    for (int i = 0; i < end; ++i) {
        const glm::vec3 normal = vertices.geometric_normal.get(i), weight = scattered.weight.get(i);
        const float outwards = glm::dot(normal, rays.direction.get(i));
        const float bulge = outwards > 0.0f ? 0.0f : vertices.bulge[i];
        rise[i] = passes[i] != 0 ? 0.0f : bulge;
        const float open = std::max(outwards, std::max(rise[i], passes[i] != 0 ? 1.0f : 0.0f));
        leaves[i] = std::min(open, weight.x + weight.y + weight.z) > 0.0f ? 1.0f : 0.0f;
        const float height = rise[i] * glm::dot(normal, vertices.shading_normal.get(i));
        scattered.face_plane[i] = height / -outwards;  // where there is no rise: nothing over something
    }
    close_hidden_bulges(vertices, rise, workspace.to_bulges, leaves, ray_count);
    const auto leaving = std::count(leaves.begin(), leaves.begin() + count, 1.0f);
    scattered.clear();
    if (leaving == count && std::count(passes.begin(), passes.begin() + count, 1) == 0) {
        scattered.all_leave = true;
        for (int i = 0; i < end; ++i) {
            scattered.vertex[i] = i;
            rays.set_origin(i, vertices.origin(i, rise[i]), infinite_distance, vertices.time[i]);
        }
        rays.count = count;
        return;
    }
    for (int i = 0; i < count; ++i) {
        if (leaves[i] == 0.0f) {
            scattered.ended[scattered.ended_count++] = i;
            continue;
        }
        scattered.keep(i, passes[i] != 0 ? vertices.specular[i].far_side : vertices.origin(i, rise[i]),
                       vertices.time[i]);
    }
}

// Lets the rays that met a transparent surface pass it, or not, by chance, until each ends at a surface to be scattered
// at.
void PathIntegrator::pass_panes(const VertexBatch& vertices, int vertex, Start start, ScatteredRays& scattered,
                                HitBatch& hits, int& rays) const {
    for (int i = 0; i < scattered.rays.count; ++i) {
        const glm::vec3 origin = scattered.rays.origin.get(i), direction = scattered.rays.direction.get(i);
        const SampleIndex index = vertices.samples.get(scattered.vertex[i]);
        for (std::uint32_t pane = 0; !hits.missed(i) && !scene_.is_plain(hits.instance[i]); ++pane) {
            const SurfacePoint point = scene_.surface_point(hits.get(i), direction, scattered.rays.time[i]);
            if (!point.specular.is_transparent()) break;
            const glm::vec3 specular = scene_.specular_albedo(point.specular, point.shading_normal, -direction);
            const glm::vec3 passing = point.specular.transmission * (1.0f - specular);
            // Paths have to end at a pane that glows, or none would find its light.
            const float glowing = point.emission != glm::vec3(0.0f) ? largest(passing) : 0.0f;
            const float ending = std::max(glowing, largest(point.albedo * (1.0f - specular) + specular));
            const float share = largest(passing) / (largest(passing) + ending);
            const std::uint32_t use = path_dimension(vertex, start == Start::specular, VertexUse::pane_pick, pane);
            const glm::vec3 weight = scattered.weight.get(i);
            if (sobol_point(index, mix_word(use)).x >= share) {
                scattered.weight.set(i, weight / (1.0f - share));
                break;
            }
            scattered.weight.set(i, weight * passing / share);
            hits.set(i, scene_.intersect(origin, direction, std::nextafter(hits.distance[i], infinite_distance),
                                         scattered.rays.farthest[i], RayCoherence::incoherent, scattered.rays.time[i],
                                         layers_));
            ++rays;
        }
    }
}

// Russian roulette: a path goes on with a probability of its throughput, and counts for the ones that did not.
bool PathIntegrator::survives_roulette(const SampleIndex& sample, int vertex, Start start,
                                       glm::vec3& throughput) const {
    const float probability = std::min(1.0f, largest(throughput));
    const std::uint32_t use = path_dimension(vertex, start == Start::specular, VertexUse::roulette);
    if (sobol_point(sample, mix_word(use)).x >= probability) return false;
    throughput /= probability;
    return true;
}

PLUMBLINE_FOR_EACH_MACHINE
void PathIntegrator::arrive(const VertexBatch& from, int vertex, Start start, bool looks_for_emitters,
                            PathWorkspace& workspace, VectorLanes& sum, VertexBatch& next) const {
    const ScatteredRays& scattered = workspace.scattered;
    const RayBatch& rays = scattered.rays;
    const HitBatch& hits = workspace.hits;
    MetRays& met = workspace.met;
    met.find(rays, hits);
    scene_.surface_points(rays, hits, met, next);
    const int end = whole_groups(met.count);
    PLUMBLINE_INDEPENDENT_LANES
    for (int j = 0; j < end; ++j) {
        const int i = met.ray[j], lane = scattered.vertex[i];
        next.path[j] = from.path[lane];
        next.samples.set(j, from.samples.get(lane));
        next.time[j] = rays.time[i];
        next.throughput.set(j, from.throughput.get(lane) * scattered.weight.get(i));
    }
    Lanes<float> glows, reflects;
    for (int j = 0; j < end; ++j) {
        glows[j] = next.emission.x[j] + next.emission.y[j] + next.emission.z[j];
        reflects[j] = next.albedo.x[j] + next.albedo.y[j] + next.albedo.z[j];
    }
    const bool limited = is_limited(start, vertex);
    const auto counts = [&](int j) { return limited ? counted(start, hits.distance[met.ray[j]]) : 1.0f; };
    const bool bulges = scene_.anything_bulges();
    const auto face_sees = [&](int j) {
        return bulges && hits.distance[met.ray[j]] < scattered.face_plane[met.ray[j]];
    };
    for (int j = 0; j < met.count && looks_for_emitters; ++j) {
        if (glows[j] == 0.0f || face_sees(j)) continue;
        const int i = met.ray[j];
        const float weight = lights_.emission_weight(hits.get(i), next.geometric_normal.get(j), rays.direction.get(i),
                                                     scattered.density[i], rays.time[i]);
        // What a diffuse lobe gets straight from an emitter is direct light, which knows no radius.
        const float reached = start == Start::specular ? counts(j) : 1.0f;
        sum.add(next.path[j], next.throughput.get(j) * next.emission.get(j) * (weight * reached));
    }
    const bool goes_on = vertex < plan_.bounces && (start == Start::specular || plan_.indirect);
    if (!goes_on) return;
    // Paths that go on close up.
    const bool roulette = plan_.roulette_after > 0 && vertex >= plan_.roulette_after;
    int count = 0;
    for (int j = 0; j < met.count; ++j) {
        const float share = counts(j);
        if (!(share > 0.0f) || face_sees(j)) continue;
        if (reflects[j] == 0.0f && scene_.is_plain(hits.instance[met.ray[j]])) continue;
        glm::vec3 throughput = next.throughput.get(j) * share;
        if (roulette && !survives_roulette(next.samples.get(j), vertex + 1, start, throughput)) continue;
        if (count != j) next.set(count, next, j), met.ray[count] = met.ray[j];
        if (limited || roulette) next.throughput.set(count, throughput);
        ++count;
    }
    next.count = met.count = count;
    add_lobes(rays, hits, met, next);
}

void PathIntegrator::follow(const VertexBatch& starts, Start start, PathWorkspace& workspace,
                            BatchEstimate& estimate) const {
    const bool diffuse_start = start == Start::diffuse;
    ScatteredRays& scattered = workspace.scattered;
    RayBatch& rays = scattered.rays;
    const VertexBatch* vertices = &starts;
    VertexBatch *next = &workspace.next, *other = &workspace.vertices;
    for (int k = 0; vertices->count > 0; ++k) {
        const bool gathers = !diffuse_start || (k == 0 ? plan_.direct : plan_.indirect);
        VectorLanes& sum = diffuse_start ? estimate.radiance[k] : estimate.reflection;
        if (gathers) next_event(*vertices, k, start, workspace, sum, estimate.rays);

        // A mirror's rays, and those that pass a pane, find emitters whatever the strategy.
        const bool looks_for_emitters = gathers && (lights_.rays_find_emitters() || scene_.has_delta_lobes());
        const bool goes_on = k < plan_.bounces && (!diffuse_start || plan_.indirect);
        const bool tests_visibility = diffuse_start && k == 0 && plan_.ao;
        if (!looks_for_emitters && !goes_on && !tests_visibility) return;

        scatter(*vertices, k, start, workspace, estimate.rays);
        const float nearest_visibility = 1.0f - obscurance(0.0f);
        if (tests_visibility) {
            for (int i = 0; i < scattered.ended_count; ++i) {
                estimate.ambient_visibility[vertices->path[scattered.ended[i]]] = nearest_visibility;
            }
        }
        if (!looks_for_emitters && diffuse_start && k == 0) {
            const float reach =
                std::max(goes_on ? plan_.indirect_radius : 0.0f, tests_visibility ? plan_.ao_radius : 0.0f);
            std::fill_n(rays.farthest.begin(), rays.count, reach);
        }
        estimate.rays += rays.count;
        const auto path_of = [&](int i) { return vertices->path[scattered.vertex[i]]; };
        const bool background_counts = diffuse_start || !is_limited(start, k);
        const auto gather_background = [&](int i) {
            const glm::vec3 found = lights_.weighted_background(rays.direction.get(i), scattered.density[i]);
            if (found == glm::vec3(0.0f)) return;
            sum.add(path_of(i), vertices->throughput.get(scattered.vertex[i]) * scattered.weight.get(i) * found);
        };

        // Where only the fact of a hit matters, the cheaper query does.
        const bool any_hit_serves = !goes_on && diffuse_start && !scene_.has_delta_lobes() &&
                                    !(looks_for_emitters && lights_.rays_find_triangles()) &&
                                    !(tests_visibility && (looks_for_emitters || plan_.ao_falloff != Falloff::hard));
        if (any_hit_serves) {
            Lanes<int> blocked;
            scene_.occluded(rays, blocked, layers_);
            if (tests_visibility && scattered.all_leave && starts.each_its_path) {
                for (int i = 0; i < rays.count; ++i) {
                    estimate.ambient_visibility[i] = blocked[i] ? nearest_visibility : 1.0f;
                }
            } else if (tests_visibility) {
                for (int i = 0; i < rays.count; ++i) {
                    if (blocked[i]) estimate.ambient_visibility[path_of(i)] = nearest_visibility;
                }
            }
            for (int i = 0; i < rays.count && looks_for_emitters; ++i) {
                if (!blocked[i]) gather_background(i);
            }
            return;
        }
        HitBatch& hits = workspace.hits;
        scene_.intersect(rays, hits, layers_);
        if (tests_visibility) {
            for (int i = 0; i < rays.count; ++i) {
                if (hits.missed(i)) continue;
                estimate.ambient_visibility[path_of(i)] = 1.0f - obscurance(hits.distance[i]);
            }
        }
        if (!looks_for_emitters && !goes_on) return;
        if (scene_.has_transparency()) pass_panes(*vertices, k, start, scattered, hits, estimate.rays);
        if (looks_for_emitters && lights_.has_background() && background_counts) {
            for (int i = 0; i < rays.count; ++i) {
                if (hits.missed(i)) gather_background(i);
            }
        }
        next->clear();
        arrive(*vertices, k, start, looks_for_emitters, workspace, sum, *next);
        vertices = next;
        std::swap(next, other);
    }
}

void PathIntegrator::estimate(const VertexBatch& starts, PathWorkspace& workspace, BatchEstimate& estimate) const {
    estimate.ambient_visibility.fill(0, starts.count, 1.0f);
    estimate.radiance.resize(static_cast<std::size_t>(plan_.bounces) + 1);  // once for the estimate of a thread
    const bool gathers = plan_.direct || plan_.indirect || plan_.irradiance;
    for (VectorLanes& radiance : estimate.radiance) {
        if (gathers) radiance.fill(0, starts.count, glm::vec3(0.0f));
    }
    if (plan_.reflection) estimate.reflection.fill(0, starts.count, glm::vec3(0.0f));
    estimate.rays = 0;

    if (plan_.ao || plan_.irradiance) {
        follow(starts, Start::diffuse, workspace, estimate);
    } else if (plan_.direct || plan_.indirect) {
        // Nothing that x receives matters where x is black, unless the irradiance or what is near is wanted.
        VertexBatch& lit = workspace.starts;
        lit.clear();
        for (int i = 0; i < starts.count; ++i) {
            if (starts.albedo.get(i) != glm::vec3(0.0f)) lit.add(starts, i);
        }
        follow(lit.count == starts.count ? starts : lit, Start::diffuse, workspace, estimate);
    }
    if (!plan_.reflection) return;
    VertexBatch& specular = workspace.starts;
    specular.clear();
    for (int i = 0; i < starts.count; ++i) {
        if (!starts.is_plain[i]) specular.add(starts, i);
    }
    follow(specular, Start::specular, workspace, estimate);
}

}  // namespace plumb

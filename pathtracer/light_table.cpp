#include "pathtracer/light_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/gtc/constants.hpp>

#include "pathtracer/direction_sampling.h"
#include "pathtracer/luminance.h"

namespace plumb {
namespace {

constexpr std::uint32_t no_emitter = 0xffffffffu;

// KHR_lights_punctual, as SpotLight says; equal angles make a hard edge.
float spot_attenuation(const SpotLight& light, float cosine) {
    const float outer = std::cos(light.outer_angle), inner = std::cos(light.inner_angle);
    if (inner <= outer) return cosine >= outer ? 1.0f : 0.0f;
    const float t = std::clamp((cosine - outer) / (inner - outer), 0.0f, 1.0f);
    return t * t;
}

LightSample from_point(const glm::vec3& receiver, const glm::vec3& position) {
    LightSample sample;
    const glm::vec3 offset = position - receiver;
    const float squared = glm::dot(offset, offset);
    if (!(squared > 0.0f)) return sample;
    sample.direction = offset / std::sqrt(squared);
    sample.end = position;
    sample.radiance = glm::vec3(1.0f / squared);
    return sample;
}

// Mean luminance over the texels of a texture that multiplies an emission, so that a texture with a few bright spots
// counts for what it emits.
double mean_emission(const Scene& scene, const Material& material) {
    if (material.emission_texture == no_texture) return luminance(material.emission);
    const Texture& texture = scene.textures[material.emission_texture];
    double sum = 0.0;
    for (std::size_t i = 0; i < texture.texels.size(); i += 4) {
        sum +=
            luminance(material.emission * glm::vec3(texture.texels[i], texture.texels[i + 1], texture.texels[i + 2]));
    }
    return texture.texels.empty() ? 0.0 : 4.0 * sum / static_cast<double>(texture.texels.size());
}

}  // namespace

LightTable::LightTable(const TracedScene& traced, const EnvironmentDistribution& environment, EmitterSampling strategy)
    : scene_(traced), environment_(environment), strategy_(strategy) {
    const Scene& scene = traced.scene();
    std::vector<double> powers;
    find_emitters(powers);
    if (strategy == EmitterSampling::directions) std::fill(powers.begin(), powers.end(), 0.0);

    // Cosine-distributed rays are already ideal for a constant environment, so it is sampled only where nothing else
    // may be.
    const bool has_environment = !scene.environment.is_black();
    const bool image = has_environment && !environment.empty();
    const bool environment_sampled =
        has_environment && (strategy == EmitterSampling::lights || (image && strategy == EmitterSampling::both));
    const double emitter_power = std::accumulate(powers.begin(), powers.end(), 0.0);
    environment_index_ = powers.size();
    powers.push_back(!environment_sampled ? 0.0 : emitter_power > 0.0 ? emitter_power : 1.0);
    extended_ = DiscreteDistribution(powers);
    lights_without_extent_ = scene.point_lights.size() + scene.spot_lights.size() + scene.directional_lights.size();

    const bool rays = strategy != EmitterSampling::lights;
    rays_find_triangles_ = rays && !emitters_.empty();
    rays_find_environment_ = rays && has_environment;
}

void LightTable::find_emitters(std::vector<double>& powers) {
    const Scene& scene = scene_.scene();
    first_emitter_.assign(scene.instances.size(), no_emitter);
    std::vector<double> material_emission(scene.materials.size(), -1.0);  // looked up once, textures are large
    for (std::uint32_t instance = 0; instance < scene.instances.size(); ++instance) {
        const Material& material = scene_.material(instance);
        if (!material.is_emissive()) continue;
        double& mean = material_emission[static_cast<std::size_t>(&material - scene.materials.data())];
        if (mean < 0.0) mean = mean_emission(scene, material);
        if (!(mean > 0.0)) continue;
        first_emitter_[instance] = static_cast<std::uint32_t>(emitters_.size());
        for (std::uint32_t i = 0; i < scene_.triangle_count(instance); ++i) {
            const TracedTriangle triangle = scene_.triangle(instance, i);
            const float area = 0.5f * glm::length(triangle.scaled_normal());
            // Where a texture varies, a few lookups guide the choice and the mean keeps every triangle possible.
            double emitted = mean;
            if (material.emission_texture != no_texture) {
                constexpr float third = 1.0f / 3.0f, near = 0.6f, far = 0.2f;
                for (const glm::vec2 at :
                     {glm::vec2(third), glm::vec2(far), glm::vec2(near, far), glm::vec2(far, near)}) {
                    const glm::vec2 uv = triangle.uv(at.x, at.y);
                    emitted += luminance(scene_.surface_sample(instance, uv).emission);
                }
                emitted /= 5.0;
            }
            const glm::vec3 normal = area > 0.0f ? triangle.scaled_normal() / (2.0f * area) : glm::vec3(0.0f);
            emitters_.push_back({triangle, normal, triangle.error(), area, instance});
            powers.push_back(glm::pi<double>() * area * emitted * (material.two_sided ? 2.0 : 1.0));
        }
    }
}

LightSample LightTable::sample_extended(const glm::vec3& receiver, const glm::vec3& normal, float pick,
                                        glm::vec2 u) const {
    const std::size_t index = extended_.sample(pick);
    const double probability = extended_.probability(index);
    return index == environment_index_ ? sample_environment(probability, normal, u)
                                       : sample_emitter(emitters_[index], probability, receiver, u);
}

// Weighted reservoir sampling: each light replaces the one kept so far with probability weight / (sum so far), and the
// random number is stretched to be used again.
LightSample LightTable::sample_without_extent(const glm::vec3& receiver, const glm::vec3& normal, float pick) const {
    LightSample kept;
    double sum = 0.0, kept_weight = 0.0, u = pick;
    for (std::size_t i = 0; i < lights_without_extent_; ++i) {
        const LightSample light = light_without_extent(i, receiver);
        const double weight = luminance(light.radiance) * std::max(0.0f, glm::dot(normal, light.direction));
        if (!(weight > 0.0)) continue;
        sum += weight;
        const double share = weight / sum;
        if (u < share) {
            kept = light, kept_weight = weight;
            u /= share;
        } else {
            u = (u - share) / (1.0 - share);
        }
    }
    if (kept_weight > 0.0) kept.radiance *= static_cast<float>(sum / kept_weight);
    return kept;
}

LightSample LightTable::sample_emitter(const Emitter& emitter, double probability, const glm::vec3& receiver,
                                       glm::vec2 u) const {
    const TracedTriangle& triangle = emitter.corners;
    const Material& material = scene_.material(emitter.instance);
    const glm::vec2 at = sample_triangle(u);
    const glm::vec3 position = triangle.point(at.x, at.y);
    LightSample sample = from_point(receiver, position);
    const glm::vec3& normal = emitter.normal;
    const float cosine = -glm::dot(normal, sample.direction);
    if (cosine == 0.0f || (cosine < 0.0f && !material.two_sided)) return {};
    const glm::vec2 uv = triangle.uv(at.x, at.y);
    if (material.alpha_mask && !scene_.scene().is_opaque(material, uv)) return {};
    // The ray stops short of the emitter by the rounding errors of both ends.
    const glm::vec3 error = emitter.error + 0x1p-20f * glm::abs(receiver);
    const glm::vec3 side = cosine > 0.0f ? normal : -normal;
    sample.end = position + glm::dot(glm::abs(normal), error) * side;
    // From density per area to density per solid angle: d^2 / cosine; from_point left 1 / d^2 in `radiance`.
    const float inverse_density = sample.radiance.x * std::abs(cosine) * emitter.area / static_cast<float>(probability);
    if (!(inverse_density > 0.0f)) return {};
    sample.density = 1.0f / inverse_density;
    sample.radiance = inverse_density * scene_.surface_sample(emitter.instance, uv).emission;
    return sample;
}

LightSample LightTable::sample_environment(double probability, const glm::vec3& normal, glm::vec2 u) const {
    LightSample sample;
    sample.infinitely_far = true;
    if (environment_.empty()) {
        sample.direction = sample_cosine_hemisphere(normal, u);
        sample.density = glm::dot(normal, sample.direction) * glm::one_over_pi<float>();
    } else {
        const EnvironmentSample chosen = environment_.sample(u);
        sample.direction = chosen.direction, sample.density = chosen.density;
    }
    sample.density *= static_cast<float>(probability);
    if (!(sample.density > 0.0f)) return {};
    sample.radiance = scene_.scene().environment_radiance(sample.direction) / sample.density;
    return sample;
}

glm::vec3 LightTable::weighted_emission(const SurfaceHit& hit, const SurfacePoint& point, const glm::vec3& direction,
                                        float cosine) const {
    if (!rays_find_triangles_ || point.emission == glm::vec3(0.0f)) return glm::vec3(0.0f);
    if (strategy_ == EmitterSampling::directions) return point.emission;
    const std::size_t index = first_emitter_[hit.instance] + hit.triangle;
    const float cosine_there = std::abs(glm::dot(point.geometric_normal, direction));
    if (!(cosine_there > 0.0f)) return point.emission;
    const float density = static_cast<float>(extended_.probability(index)) * hit.distance * hit.distance /
                          (emitters_[index].area * cosine_there);
    return point.emission * power_heuristic(cosine * glm::one_over_pi<float>(), density);
}

glm::vec3 LightTable::weighted_environment(const glm::vec3& direction, float cosine) const {
    if (!rays_find_environment_) return glm::vec3(0.0f);
    const glm::vec3 radiance = scene_.scene().environment_radiance(direction);
    const double probability = extended_.empty() ? 0.0 : extended_.probability(environment_index_);
    if (!(probability > 0.0)) return radiance;
    const float density = static_cast<float>(probability) * environment_.density(direction);
    return radiance * power_heuristic(cosine * glm::one_over_pi<float>(), density);
}

LightSample LightTable::light_without_extent(std::size_t index, const glm::vec3& receiver) const {
    const Scene& scene = scene_.scene();
    if (index < scene.point_lights.size()) {
        const PointLight& light = scene.point_lights[index];
        LightSample sample = from_point(receiver, light.position);
        sample.radiance *= light.intensity;
        return sample;
    }
    index -= scene.point_lights.size();
    if (index < scene.spot_lights.size()) {
        const SpotLight& light = scene.spot_lights[index];
        LightSample sample = from_point(receiver, light.position);
        sample.radiance *= light.intensity * spot_attenuation(light, -glm::dot(light.direction, sample.direction));
        return sample;
    }
    const DirectionalLight& light = scene.directional_lights[index - scene.spot_lights.size()];
    LightSample sample;
    sample.direction = -light.direction;
    sample.infinitely_far = true;
    sample.radiance = light.irradiance;
    return sample;
}

}  // namespace plumb

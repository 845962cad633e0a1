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

// A light that the receiver's bulge sees, told for the receiver.
LightSample risen(const LightReceiver& receiver, LightSample sample) {
    sample.rise = receiver.bulge;
    return sample;
}

// Mean luminance over the texels of a texture that multiplies an emission, so that a texture with a few bright spots
// counts for what it emits.
double mean_emission(const Scene& scene, const Material& material) {
    if (material.emission_texture == no_texture) return luminance(material.emission);
    const Texture& texture = scene.textures[material.emission_texture];
    double sum = 0.0;
    for (std::size_t i = 0; i < texture.value_count(); i += 4) {
        sum += luminance(material.emission * glm::vec3(texture.value(i), texture.value(i + 1), texture.value(i + 2)));
    }
    return texture.value_count() == 0 ? 0.0 : 4.0 * sum / static_cast<double>(texture.value_count());
}

// A point on a triangle that emits, as a receiver sees it. Without branches, for loops over lanes.
struct TriangleSample {
    glm::vec3 direction, shadow_ray;
    float inverse_density;  // per solid angle; 0: no light from there
    glm::vec2 at;           // barycentric weights of the second and third corner
};

PLUMBLINE_INLINE TriangleSample sample_emitting_triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                                                         const glm::vec3& normal, float area_over_probability,
                                                         float error, float back_emits, const glm::vec3& receiver,
                                                         glm::vec2 u) {
    TriangleSample sample;
    sample.at = sample_triangle(u);
    const glm::vec3 offset = (1.0f - sample.at.x - sample.at.y) * a + sample.at.x * b + sample.at.y * c - receiver;
    const float squared = glm::dot(offset, offset);
    const float inverse_distance = squared > 0.0f ? 1.0f / std::sqrt(squared) : 0.0f;
    sample.direction = offset * inverse_distance;
    const float cosine = -glm::dot(normal, sample.direction);
    const float seen = cosine > 0.0f ? cosine : -cosine * back_emits;
    // From density per area to density per solid angle: d^2 / cosine.
    sample.inverse_density = seen * area_over_probability * inverse_distance * inverse_distance;
    // The ray stops short of the emitter by the rounding errors of both ends.
    const float step = error + coordinate_error * glm::dot(glm::abs(normal), glm::abs(receiver));
    sample.shadow_ray = offset + (cosine > 0.0f ? step : -step) * normal;
    return sample;
}

}  // namespace

// Without branches, for loops over lanes. The cone is KHR_lights_punctual's, as SpotLight says; equal angles make a
// hard edge.
PLUMBLINE_INLINE LightSample LightTable::from_local_light(const LocalLight& light, const glm::vec3& receiver) {
    const glm::vec3 offset = light.position - receiver;
    const float squared = glm::dot(offset, offset), distance = std::sqrt(squared);
    const bool apart = squared > 0.0f;
    LightSample sample;
    sample.direction = offset * (apart ? 1.0f / distance : 0.0f);
    sample.shadow_ray = offset;
    sample.farthest = 1.0f;
    const float cosine = -glm::dot(light.axis, sample.direction), width = light.inner_cosine - light.outer_cosine;
    const float inside = width > 0.0f                   ? (cosine - light.outer_cosine) / width
                         : cosine >= light.outer_cosine ? 1.0f
                                                        : 0.0f;
    const float share = std::clamp(inside, 0.0f, 1.0f);
    const float received = share * share / light.attenuation.divisor(distance, squared);
    sample.radiance = light.intensity * (apart ? received : 0.0f);
    return sample;
}

LightTable::LightTable(const TracedScene& traced, const EnvironmentDistribution& environment, EmitterSampling strategy)
    : scene_(traced), environment_(environment), strategy_(strategy) {
    const Scene& scene = traced.scene();
    std::vector<double> powers;
    find_emitters(powers);
    find_suns(powers);
    if (strategy == EmitterSampling::directions) std::fill(powers.begin(), powers.end(), 0.0);

    // Cosine-distributed rays are already ideal for a constant environment, so it is sampled only where nothing else
    // may be.
    const bool has_environment = !scene.environment.is_black();
    const bool image = has_environment && !environment.empty();
    const bool environment_sampled =
        has_environment && (strategy == EmitterSampling::lights || (image && strategy == EmitterSampling::both));
    const double other_power = std::accumulate(powers.begin(), powers.end(), 0.0);
    powers.push_back(!environment_sampled ? 0.0 : other_power > 0.0 ? other_power : 1.0);
    extended_ = DiscreteDistribution(powers);
    if (!extended_.empty()) {
        std::size_t index = 0;
        for (Emitter& emitter : emitters_) {
            emitter.probability = static_cast<float>(extended_.probability(index++));
            emitter.area_over_probability = emitter.area / emitter.probability;
        }
        for (Sun& sun : suns_) sun.probability = static_cast<float>(extended_.probability(index++));
        environment_probability_ = static_cast<float>(extended_.probability(index));
    }
    only_plain_emitters_ = suns_.empty() && !environment_sampled &&
                           std::ranges::none_of(emitters_, [](const Emitter& e) { return e.varies || e.moves; });
    for (const PointLight& light : scene.point_lights) {
        local_.push_back({light.position, glm::vec3(0.0f), light.intensity, light.attenuation, -1.0f, -1.0f});
    }
    for (const SpotLight& light : scene.spot_lights) {
        local_.push_back({light.position, light.direction, light.intensity, light.attenuation,
                          std::cos(light.outer_angle), std::cos(light.inner_angle)});
    }
    lights_without_extent_ = local_.size() + parallel_.size();

    const bool rays = strategy != EmitterSampling::lights;
    rays_find_triangles_ = rays && !emitters_.empty();
    rays_find_background_ = rays && (has_environment || !suns_.empty());
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
            Emitter emitter;
            emitter.instance = instance, emitter.triangle = i;
            emitter.two_sided = material.two_sided;
            emitter.varies = material.emission_texture != no_texture || material.alpha_mask;
            emitter.emission = material.emission;
            emitter.moves = scene_.moves(instance);
            emitter = moved(emitter, now);
            // Where a texture varies, a few lookups guide the choice and the mean keeps every triangle possible.
            double emitted = mean;
            if (material.emission_texture != no_texture) {
                constexpr float third = 1.0f / 3.0f, near = 0.6f, far = 0.2f;
                for (const glm::vec2 at :
                     {glm::vec2(third), glm::vec2(far), glm::vec2(near, far), glm::vec2(far, near)}) {
                    emitted += luminance(scene_.surface_sample(instance, emitter.corners.uv(at.x, at.y)).emission);
                }
                emitted /= 5.0;
            }
            powers.push_back(glm::pi<double>() * emitter.area * emitted * (material.two_sided ? 2.0 : 1.0));
            emitters_.push_back(emitter);
        }
    }
}

void LightTable::find_suns(std::vector<double>& powers) {
    const Scene& scene = scene_.scene();
    const float radius = 0.5f * scene.bounds().diagonal();
    for (std::size_t i = 0; i < scene.directional_lights.size(); ++i) {
        const DirectionalLight& light = scene.directional_lights[i];
        if (!(light.angular_radius > 0.0f)) {
            parallel_.push_back(i);
            continue;
        }
        // The irradiance of a disc of radiance L on a surface that faces it is L pi sin^2(radius).
        const float sine = std::sin(light.angular_radius);
        Sun sun;
        sun.axis = -light.direction;
        sun.radiance = light.irradiance / (glm::pi<float>() * sine * sine);
        sun.height = cap_height(light.angular_radius);
        sun.density = cone_density(sun.height);
        suns_.push_back(sun);
        powers.push_back(luminance(light.irradiance) * glm::pi<double>() * radius * radius);
    }
}

// The emitter with what depends on where it stands.
LightTable::Emitter LightTable::moved(const Emitter& emitter, float time) const {
    Emitter there = emitter;
    there.corners = scene_.triangle(emitter.instance, emitter.triangle, time);
    const glm::vec3 scaled_normal = there.corners.scaled_normal();
    there.area = 0.5f * glm::length(scaled_normal);
    there.normal = there.area > 0.0f ? scaled_normal / (2.0f * there.area) : glm::vec3(0.0f);
    if (there.probability > 0.0f) there.area_over_probability = there.area / there.probability;
    there.error = glm::dot(glm::abs(there.normal), there.corners.error());
    return there;
}

// Which point of the lights is sampled depends on the numbers alone, so that the bulge looks at the point that the
// origin's face hides, and each point is seen from one of the two.
LightSample LightTable::sample_extended(const LightReceiver& receiver, double x, float y) const {
    const LightSample sample = sample_extended_from_origin(receiver, x, y);
    if (!receiver.sees_from_bulge(sample.direction)) return sample;
    return risen(receiver, sample_extended_from_origin(receiver.bulging(), x, y));
}

LightSample LightTable::sample_extended_from_origin(const LightReceiver& receiver, double x, float y) const {
    std::size_t index = extended_.sample(x);
    const glm::vec2 u(extended_.within(x, index), y);
    if (index < emitters_.size()) {
        const Emitter& emitter = emitters_[index];
        return emitter.moves ? sample_emitter(moved(emitter, receiver.time), receiver, u)
                             : sample_emitter(emitter, receiver, u);
    }
    index -= emitters_.size();
    return index < suns_.size() ? sample_sun(suns_[index], u) : sample_environment(receiver, u);
}

// Weighted reservoir sampling: each light replaces the one kept so far with probability weight / (sum so far), and the
// random number is stretched to be used again. A specular lobe may stand about another normal, and all that either lobe
// sees has to be possible.
LightSample LightTable::sample_without_extent(const LightReceiver& receiver, float pick) const {
    if (lights_without_extent_ == 1) return light_without_extent(0, receiver);
    LightSample kept;
    double sum = 0.0, kept_weight = 0.0, u = pick;
    for (std::size_t i = 0; i < lights_without_extent_; ++i) {
        const LightSample light = light_without_extent(i, receiver);
        const float cosine =
            std::max(glm::dot(receiver.normal, light.direction), glm::dot(receiver.lobe_normal, light.direction));
        const double weight = luminance(light.radiance) * std::max(0.0f, cosine);
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

PLUMBLINE_FOR_EACH_MACHINE
void LightTable::sample_without_extent(const VertexBatch& receivers, const Lanes<float>& pick,
                                       LightLanes& samples) const {
    if (lights_without_extent_ > 1) {
        for (int i = 0; i < receivers.count; ++i) {
            samples.set(i, sample_without_extent(receivers.receiver(i), pick[i]));
        }
        return;
    }
    const int end = whole_groups(receivers.count);
    if (local_.empty()) {
        // A sun, which is the same from everywhere.
        const LightSample sun = light_without_extent_from(glm::vec3(0.0f), 0);
        for (int i = 0; i < end; ++i) samples.set(i, sun);
    } else {
        const LocalLight lamp = local_.front();
        for (int i = 0; i < end; ++i) samples.set(i, from_local_light(lamp, receivers.ray_origin.get(i)));
    }
    for (int i = 0; i < receivers.count && scene_.anything_bulges(); ++i) {
        const LightReceiver receiver = receivers.receiver(i);
        if (receiver.sees_from_bulge(samples.direction.get(i))) samples.set(i, light_without_extent(0, receiver));
    }
}

LightSample LightTable::sample_emitter(const Emitter& emitter, const LightReceiver& receiver, glm::vec2 u) const {
    const TriangleSample chosen = sample_emitting_triangle(emitter.corners.a, emitter.corners.b, emitter.corners.c,
                                                           emitter.normal, emitter.area_over_probability, emitter.error,
                                                           emitter.two_sided ? 1.0f : 0.0f, receiver.origin, u);
    LightSample sample;
    sample.direction = chosen.direction, sample.shadow_ray = chosen.shadow_ray;
    if (!(chosen.inverse_density > 0.0f)) return sample;
    sample.farthest = 1.0f;
    sample.density = 1.0f / chosen.inverse_density;
    sample.radiance = chosen.inverse_density * emitter.emission;
    if (emitter.varies) {
        const glm::vec2 uv = emitter.corners.uv(chosen.at.x, chosen.at.y);
        if (!scene_.is_opaque(emitter.instance, uv)) return {};
        sample.radiance = chosen.inverse_density * scene_.surface_sample(emitter.instance, uv).emission;
    }
    return sample;
}

// A few emitters are set one after the other in all lanes that chose them: looking up takes each lane by itself.
PLUMBLINE_FOR_EACH_MACHINE
void LightTable::look_up(const Lanes<std::uint32_t>& chosen, int count, EmitterLanes& lanes) const {
    constexpr std::uint32_t few = 4;
    const int end = whole_groups(count);
    if (emitters_.size() > few) {
        for (int i = 0; i < end; ++i) lanes.set(i, emitters_[chosen[i]]);
        return;
    }
    for (std::uint32_t index = 0; index < emitters_.size(); ++index) {
        const Emitter& emitter = emitters_[index];
        const auto set = [&](Lanes<float>& lane, float value) {
            if (index == 0) {
                lane.fill(0, count, value);
            } else {
                for (int i = 0; i < end; ++i) lane[i] = chosen[i] == index ? value : lane[i];
            }
        };
        const auto set_vector = [&](VectorLanes& lane, const glm::vec3& v) {
            set(lane.x, v.x), set(lane.y, v.y), set(lane.z, v.z);
        };
        set_vector(lanes.a, emitter.corners.a), set_vector(lanes.b, emitter.corners.b);
        set_vector(lanes.c, emitter.corners.c), set_vector(lanes.normal, emitter.normal);
        set_vector(lanes.emission, emitter.emission);
        set(lanes.area_over_probability, emitter.area_over_probability), set(lanes.error, emitter.error);
        set(lanes.back_emits, emitter.two_sided ? 1.0f : 0.0f);
    }
}

PLUMBLINE_FOR_EACH_MACHINE
void LightTable::sample_extended(const VertexBatch& receivers, const Lanes<std::uint32_t>& x, const Lanes<float>& y,
                                 LightLanes& samples) const {
    if (!only_plain_emitters_) {
        for (int i = 0; i < receivers.count; ++i) {
            samples.set(i, sample_extended(receivers.receiver(i), 0x1p-32 * x[i], y[i]));
        }
        return;
    }
    Lanes<std::uint32_t> chosen{};
    Lanes<float> within;
    EmitterLanes from;
    const int end = whole_groups(receivers.count);
    extended_.sample(x, receivers.count, chosen);
    look_up(chosen, receivers.count, from);
    for (int i = 0; i < end; ++i) {
        within[i] = static_cast<float>(extended_.within(0x1p-32 * x[i], chosen[i]));
    }
    for (int i = 0; i < end; ++i) {
        const TriangleSample at = sample_emitting_triangle(
            from.a.get(i), from.b.get(i), from.c.get(i), from.normal.get(i), from.area_over_probability[i],
            from.error[i], from.back_emits[i], receivers.ray_origin.get(i), {within[i], y[i]});
        samples.direction.set(i, at.direction), samples.shadow_ray.set(i, at.shadow_ray);
        samples.radiance.set(i, at.inverse_density * from.emission.get(i));
        samples.rise[i] = 0.0f, samples.farthest[i] = 1.0f;
        samples.density[i] = at.inverse_density > 0.0f ? 1.0f / at.inverse_density : 0.0f;
    }
    for (int i = 0; i < receivers.count && scene_.anything_bulges(); ++i) {
        const LightReceiver receiver = receivers.receiver(i);
        if (!receiver.sees_from_bulge(samples.direction.get(i))) continue;
        samples.set(i, sample_extended(receiver, 0x1p-32 * x[i], y[i]));
    }
}

LightSample LightTable::sample_sun(const Sun& sun, glm::vec2 u) const {
    LightSample sample;
    sample.direction = sample.shadow_ray = sample_cone(sun.axis, sun.height, u);
    sample.density = sun.density * sun.probability;
    sample.radiance = sun.radiance / sample.density;
    return sample;
}

LightSample LightTable::sample_environment(const LightReceiver& receiver, glm::vec2 u) const {
    LightSample sample;
    if (environment_.empty() && receiver.lobe_normal == receiver.normal) {
        sample.direction = sample_cosine_hemisphere(receiver.normal, u);
        sample.density = glm::dot(receiver.normal, sample.direction) * glm::one_over_pi<float>();
    } else if (environment_.empty()) {
        // The two lobes see parts of two hemispheres: from the whole sphere, which is a cap of that height.
        constexpr float height = 2.0f;
        sample.direction = sample_cone(receiver.normal, height, u);
        sample.density = cone_density(height);
    } else {
        const EnvironmentSample chosen = environment_.sample(u);
        sample.direction = chosen.direction, sample.density = chosen.density;
    }
    sample.shadow_ray = sample.direction;
    sample.density *= environment_probability_;
    if (!(sample.density > 0.0f)) return {};
    sample.radiance = scene_.scene().environment_radiance(sample.direction) / sample.density;
    return sample;
}

float LightTable::emission_weight(const SurfaceHit& hit, const glm::vec3& geometric_normal, const glm::vec3& direction,
                                  float density, float time) const {
    if (!(density > 0.0f)) return 1.0f;
    if (!rays_find_triangles_) return 0.0f;
    if (strategy_ == EmitterSampling::directions) return 1.0f;
    const Emitter& emitter = emitters_[first_emitter_[hit.instance] + hit.triangle];
    const float area = emitter.moves ? moved(emitter, time).area : emitter.area;
    const float cosine = std::abs(glm::dot(geometric_normal, direction));
    if (!(cosine > 0.0f)) return 1.0f;
    return power_heuristic(density, emitter.probability * hit.distance * hit.distance / (area * cosine));
}

glm::vec3 LightTable::weighted_background(const glm::vec3& direction, float density) const {
    const bool alone = !(density > 0.0f) || strategy_ == EmitterSampling::directions;
    if (!alone && !rays_find_background_) return glm::vec3(0.0f);
    const Scene& scene = scene_.scene();
    glm::vec3 sum(0.0f);
    if (!scene.environment.is_black()) {
        sum = scene.environment_radiance(direction);
        if (!alone && environment_probability_ > 0.0f) {
            sum *= power_heuristic(density, environment_probability_ * environment_.density(direction));
        }
    }
    for (const Sun& sun : suns_) {
        // By the chord, which is 2 (1 - cosine) squared: the cosine of a small angle has no digits left to tell.
        const glm::vec3 chord = direction - sun.axis;
        if (glm::dot(chord, chord) > 2.0f * sun.height) continue;
        sum += sun.radiance * (alone ? 1.0f : power_heuristic(density, sun.probability * sun.density));
    }
    return sum;
}

LightSample LightTable::light_without_extent(std::size_t index, const LightReceiver& receiver) const {
    const LightSample sample = light_without_extent_from(receiver.origin, index);
    if (!receiver.sees_from_bulge(sample.direction)) return sample;
    return risen(receiver, light_without_extent_from(receiver.bulging().origin, index));
}

LightSample LightTable::light_without_extent_from(const glm::vec3& origin, std::size_t index) const {
    if (index < local_.size()) return from_local_light(local_[index], origin);
    const DirectionalLight& light = scene_.scene().directional_lights[parallel_[index - local_.size()]];
    LightSample sample;
    sample.direction = sample.shadow_ray = -light.direction;
    sample.radiance = light.irradiance;
    return sample;
}

}  // namespace plumb

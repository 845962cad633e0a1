#include "pathtracer/reference_run.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "frames/parallel.h"
#include "pathtracer/exact_gbuffer.h"
#include "pathtracer/luminance.h"
#include "pathtracer/reference_error.h"

namespace plumb {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Sample counts at which the target error is looked at: fixed, so that where a run stops does not depend on its pace.
// Each is a quarter more than the one before, which wastes at most that much.
int next_error_check(int samples) {
    int count = 16;
    while (count <= samples) count += std::max(2, count / 8 * 2);
    return count;
}
bool is_error_check(int samples) { return samples >= 2 && next_error_check(samples - 1) == samples; }

// One side of all that has the material, in square metres.
double area_of(const TracedScene& traced, const Material& material) {
    double area = 0.0;
    for (std::uint32_t instance = 0; instance < traced.scene().instances.size(); ++instance) {
        if (&traced.material(instance) != &material) continue;
        for (std::uint32_t i = 0; i < traced.triangle_count(instance); ++i) {
            area += 0.5 * static_cast<double>(glm::length(traced.triangle(instance, i).scaled_normal()));
        }
    }
    return area;
}

// About the brightest radiance that a surface of the scene may show: the brightest emission, and what the other lights
// make of a white surface across the scene.
double light_level(const TracedScene& traced) {
    const Scene& scene = traced.scene();
    const Bounds bounds = scene.bounds();
    // Without a surface there is nothing for local lights to shine on.
    const double squared_size = bounds.empty() ? HUGE_VAL : std::pow(static_cast<double>(bounds.diagonal()), 2.0);
    // A texel of an image may be a sun, a surface a glowing wire: it counts as far as it would fill the exact sums with
    // a few hundred samples, and no more, or what its light makes of all else would be rounded coarsely.
    constexpr double sun_share = 0x1p-12;
    double level = std::max(static_cast<double>(luminance(scene.environment.radiance)),
                            sun_share * static_cast<double>(scene.brightest_emission()));
    for (const Material& material : scene.materials) {
        if (!material.is_emissive()) continue;
        // The light of a lamp that is seen across the scene is dimmer than itself by about its share of the squared
        // size. One of a 64th counts in full: of a view into its light, many pixels are.
        const double share = std::clamp(64.0 * area_of(traced, material) / squared_size, sun_share, 1.0);
        level = std::max(level, share * luminance(material.emission));
    }
    for (const PointLight& light : scene.point_lights) level += luminance(light.intensity) / squared_size;
    for (const SpotLight& light : scene.spot_lights) level += luminance(light.intensity) / squared_size;
    for (const DirectionalLight& light : scene.directional_lights) level += luminance(light.irradiance);
    return level;
}

EmitterSampling strategy_of(const ReferenceSettings& settings) {
    // Rays that see a part of the scene only must not be the ones that look for light.
    return settings.oracle ? EmitterSampling::lights : settings.emitter_sampling;
}

}  // namespace

ReferenceRun::ReferenceRun(const TracedScene& scene, const EnvironmentDistribution& environment, const View& view,
                           const ReferenceSettings& settings)
    : scene_(scene),
      view_(view),
      settings_(settings),
      plan_(make_plan(scene, view, settings)),
      lights_(scene, environment, strategy_of(settings)),
      layers_(settings.oracle
                  ? std::optional<OracleLayers>(std::in_place, scene, settings.oracle->view, settings.oracle->layers,
                                                settings.oracle->minimum_separation)
                  : std::nullopt),
      integrator_(scene, lights_, layers_ ? &*layers_ : nullptr, plan_.estimation),
      accumulation_(view.width(), view.height(), plan_.estimation, plan_.primary_rays_are_sampled, light_level(scene)),
      hits_(plan_.primary_rays_are_sampled && plan_.gbuffer.empty() ? std::vector<SurfaceHit>{}
                                                                    : first_layer(scene, view)),
      sampler_(scene, view, settings, plan_.primary_rays_are_sampled, hits_, integrator_, accumulation_) {
    state_.begin = state_.end = settings.first_sample;
    find_exact_parts();
    state_.seconds = seconds_since(begun_);
}

// What is the same for every sample through a pixel's centre.
void ReferenceRun::find_exact_parts() {
    if (plan_.primary_rays_are_sampled) return;
    exact_.emission = ZeroedArray<glm::vec3>(hits_.size());
    if (plan_.estimation.direct) exact_.direct = ZeroedArray<glm::vec3>(hits_.size());
    std::atomic<std::uint64_t> rays{hits_.size()};
    parallel_for(view_.height(), [&](int y) {
        std::uint64_t row_rays = 0;
        VertexBatch start;
        for (int x = 0; x < view_.width(); ++x) {
            const Ray ray = view_.pixel_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const std::size_t pixel = pixel_index(view_, x, y);
            if (hits_[pixel].missed()) {
                exact_.emission[pixel] = scene_.scene().environment_radiance(ray.direction);
                continue;
            }
            const SurfacePoint point = scene_.surface_point(hits_[pixel], ray.direction);
            exact_.emission[pixel] = point.emission;
            if (!plan_.estimation.direct) continue;
            start.clear();
            const glm::vec3 albedo = integrator_.add_start(point, ray.direction, {}, now, start);
            exact_.direct[pixel] = albedo * integrator_.exact_direct(point, row_rays);
        }
        rays += row_rays;
    });
    state_.rays = rays;
}

// False where the exact parts are everything.
bool ReferenceRun::has_noise() const {
    const EstimationPlan& plan = plan_.estimation;
    if (plan_.primary_rays_are_sampled) return !plan_.stochastic.empty();
    const bool noisy_direct = plan.direct && (lights_.has_extended_lights() || lights_.rays_find_emitters());
    return plan.ao || plan.indirect || plan.reflection || noisy_direct;
}

double ReferenceRun::worst_error() const {
    double worst = 0.0;
    for (const StochasticPlane& plane : plan_.stochastic) {
        worst = std::max(worst, accumulation_.relative_error(plane, samples_done(), exact_));
    }
    return worst;
}

CheckpointKey ReferenceRun::key() const {
    return CheckpointKey::of(scene_.scene(), scene_.span(), view_, settings_, scene_.embree_fingerprint());
}

void ReferenceRun::resume(const ReferenceControl& control) {
    if (control.checkpoint.empty() || !std::filesystem::exists(control.checkpoint)) return;
    const CheckpointState found = add_checkpoint(control.checkpoint, key(), accumulation_.values());
    if (found.begin != settings_.first_sample || found.end > settings_.samples) {
        throw ReferenceError(fmt::format(
            "checkpoint '{}' holds samples {} to {} per pixel, which do not begin those asked for, {} to {}; ask for "
            "at least as many from the same one on, or remove it",
            control.checkpoint.string(), found.begin, found.end, settings_.first_sample, settings_.samples));
    }
    state_ = found;
}

bool ReferenceRun::sample(const ReferenceControl& control) {
    constexpr double pass_seconds = 1.0;
    // The first pass, before the pace is known, is what few machines take much longer for; not all of a small image's
    // samples, so that there is something to tell of.
    constexpr double first_pass_rays = 2e6, first_pass_samples = 16.0;
    const double rays_per_sample =
        static_cast<double>(view_.width()) * view_.height() * (1 + 2 * plan_.estimation.bounces);
    const Clock::time_point start = Clock::now();
    Clock::time_point last_checkpoint = start;
    resume(control);
    const double seconds_before = state_.seconds;
    if (!has_noise()) state_.end = settings_.samples;

    const double target = settings_.target_error;
    bool stopped = false;
    double seconds_per_sample = 0.0;
    while (!stopped && state_.end < settings_.samples) {
        if (target > 0.0 && is_error_check(samples_done()) && worst_error() < target) break;
        int limit = settings_.samples;
        if (target > 0.0) limit = std::min(limit, state_.begin + next_error_check(samples_done()));
        const double affordable = seconds_per_sample > 0.0
                                      ? pass_seconds / seconds_per_sample
                                      : std::min(first_pass_samples, first_pass_rays / rays_per_sample);
        const int pairs = static_cast<int>(std::clamp(0.5 * affordable, 1.0, 1e6));
        const int count = std::min(2 * pairs, limit - state_.end);

        const Clock::time_point pass_start = Clock::now();
        state_.rays += sampler_.sample(state_.end, count);
        state_.end += count;
        seconds_per_sample = seconds_since(pass_start) / count;
        state_.seconds = seconds_before + seconds_since(start);

        // Told before the question whether to stop, so that whoever watches can stop the run after this very pass.
        if (control.on_progress) {
            control.on_progress({samples_done(), settings_.samples - settings_.first_sample, worst_error(),
                                 static_cast<double>(state_.rays) / std::max(state_.seconds, 1e-9), state_.seconds});
        }
        stopped = control.stop && control.stop->load() && state_.end < settings_.samples;
        if (!control.checkpoint.empty() && (stopped || seconds_since(last_checkpoint) >= control.checkpoint_seconds)) {
            write_checkpoint(control.checkpoint, key(), state_, accumulation_.values());
            last_checkpoint = Clock::now();
        }
    }
    state_.seconds = seconds_before + seconds_since(start);
    return !stopped;
}

SampledReference::Parts ReferenceRun::run(const ReferenceControl& control) { return finish(sample(control)); }

bool ReferenceRun::run_shard(const std::filesystem::path& file, const ReferenceControl& control) {
    if (!sample(control)) return false;
    write_checkpoint(file, key(), state_, accumulation_.values());
    return true;
}

SampledReference::Parts ReferenceRun::merge(const std::vector<std::filesystem::path>& shards) {
    if (shards.empty()) throw ReferenceError("there are no shards to merge; name at least one file");
    struct Shard {
        std::filesystem::path file;
        CheckpointState state;
    };
    std::vector<Shard> read;
    std::uint64_t rays = 0;
    double seconds = 0.0;
    for (const std::filesystem::path& file : shards) {
        read.push_back({file, add_checkpoint(file, key(), accumulation_.values())});
        rays += read.back().state.rays, seconds += read.back().state.seconds;
    }
    std::ranges::sort(read, {}, [](const Shard& shard) { return shard.state.begin; });
    for (std::size_t i = 0; i < read.size(); ++i) {
        const int expected = i == 0 ? 0 : read[i - 1].state.end;
        if (read[i].state.begin != expected) {
            throw ReferenceError(
                fmt::format("shard '{}' begins with sample {}, but {} is the next after {}; shards must follow each "
                            "other from 0 on, without gap or overlap",
                            read[i].file.string(), read[i].state.begin, expected,
                            i == 0 ? std::string("nothing") : fmt::format("'{}'", read[i - 1].file.string())));
        }
    }
    state_ = {0, read.back().state.end, rays, seconds};
    return finish(true);
}

SampledReference::Parts ReferenceRun::finish(bool complete) {
    ReferenceResult result{Frame(view_.width(), view_.height()),
                           samples_done(),
                           state_.seconds,
                           state_.rays,
                           complete,
                           accumulation_.is_exact()};
    std::vector<StochasticPlane> sampled;
    const View* previous = settings_.previous_view ? &*settings_.previous_view : nullptr;
    std::vector<SurfaceHit> hits = std::move(hits_);
    for (const StochasticPlane& plane : plan_.stochastic) {
        if (plan_.primary_rays_are_sampled || plane.kind != StochasticPlane::Kind::emission) {
            sampled.push_back(plane);
        } else {
            write_gbuffer_plane(scene_, view_, nullptr, hits, plane.name, result.frame);
        }
    }
    for (int layer = 1; layer <= plan_.layers; ++layer) {
        if (layer > 1) hits = next_layer(scene_, view_, hits, settings_.minimum_separation);
        for (const std::string& plane : plan_.gbuffer) {
            if (layer_of(plane) == layer) write_gbuffer_plane(scene_, view_, previous, hits, plane, result.frame);
        }
    }
    const Quantities& quantities = settings_.quantities;
    result.frame.facts = {{"renderer", fmt::format("path tracer, Embree {}", RTC_VERSION_STRING)},
                          {"scene", scene_.scene().name},
                          {"view", view_.camera().name},
                          {"samples", fmt::format("{}", samples_done())},
                          {"seed", fmt::format("{}", settings_.seed)},
                          {"bounces", fmt::format("{}", quantities.bounces)},
                          {"ao_radius", fmt::format("{}", quantities.ao_radius)},
                          {"ao_falloff", std::string(to_string(quantities.ao_falloff))},
                          {"indirect_radius", fmt::format("{}", quantities.indirect_radius)},
                          {"indirect_falloff", std::string(to_string(quantities.indirect_falloff))},
                          {"reflection_radius", fmt::format("{}", quantities.reflection_radius)},
                          {"reflection_falloff", std::string(to_string(quantities.reflection_falloff))},
                          {"minimum_separation", fmt::format("{}", settings_.minimum_separation)},
                          {"antialias", settings_.antialias ? "yes" : "no"},
                          {"points", settings_.points == SamplePoints::sobol ? "sobol" : "random"},
                          {"roulette_after", fmt::format("{}", settings_.roulette_after)},
                          {"rays", fmt::format("{}", state_.rays)},
                          {"seconds", fmt::format("{:.3f}", state_.seconds)}};
    if (settings_.oracle) {
        result.frame.facts["oracle_layers"] =
            settings_.oracle->layers == 0 ? "all" : fmt::format("{}", settings_.oracle->layers);
        result.frame.facts["oracle_separation"] = fmt::format("{}", settings_.oracle->minimum_separation);
    }
    return {std::move(result), std::move(sampled), std::move(accumulation_), std::move(exact_)};
}

}  // namespace plumb

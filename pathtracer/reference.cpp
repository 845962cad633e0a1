#include "pathtracer/reference.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "pathtracer/accumulation.h"
#include "pathtracer/checkpoint.h"
#include "pathtracer/environment_distribution.h"
#include "pathtracer/exact_gbuffer.h"
#include "pathtracer/light_table.h"
#include "pathtracer/path_integrator.h"
#include "pathtracer/reference_error.h"
#include "pathtracer/traced_scene.h"

namespace plumb {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// The planes that are wanted, sorted by how they are found, and what has to be estimated for them.
struct RenderPlan {
    std::vector<StochasticPlane> stochastic;
    std::vector<std::string> gbuffer;
    int layers = 1;
    EstimationPlan estimation;
};

[[noreturn]] void refuse_plane(const std::string& plane) {
    throw ReferenceError(fmt::format(
        "the path tracer has no plane '{}'; it has ao, direct, indirect, indirect.1.., irradiance, emission, "
        "total, depth, normal, albedo, position, motion, instance, and layer2.depth and so on",
        plane));
}

StochasticPlane stochastic_plane(const std::string& name, int bounces) {
    using Kind = StochasticPlane::Kind;
    if (name == "ao") return {name, Kind::ao, 0};
    if (name == "emission") return {name, Kind::emission, 0};
    if (name == "direct") return {name, Kind::direct, 0};
    if (name == "indirect") return {name, Kind::indirect, 0};
    if (name == "irradiance") return {name, Kind::irradiance, 0};
    if (name == "total") return {name, Kind::total, 0};
    constexpr std::string_view prefix = "indirect.";
    if (!name.starts_with(prefix)) refuse_plane(name);
    int bounce = 0;
    const char* end_of_name = name.data() + name.size();
    const auto [end, error] = std::from_chars(name.data() + prefix.size(), end_of_name, bounce);
    if (error != std::errc() || end != end_of_name || bounce < 1) refuse_plane(name);
    if (bounce > bounces) {
        throw ReferenceError(fmt::format(
            "plane '{}' needs at least {} bounces, but only {} are asked for; raise bounces", name, bounce, bounces));
    }
    return {name, Kind::indirect_bounce, bounce};
}

RenderPlan make_plan(const ReferenceSettings& settings) {
    using Kind = StochasticPlane::Kind;
    const Quantities& quantities = settings.quantities;
    RenderPlan plan;
    EstimationPlan& estimation = plan.estimation;
    for (const std::string& name : quantities.planes) {
        if (is_gbuffer_plane(name)) {
            plan.gbuffer.push_back(name);
            plan.layers = std::max(plan.layers, layer_of(name));
            continue;
        }
        const StochasticPlane plane = stochastic_plane(name, quantities.bounces);
        plan.stochastic.push_back(plane);
        estimation.ao |= plane.kind == Kind::ao;
        estimation.direct |= plane.kind == Kind::direct || plane.kind == Kind::total;
        estimation.irradiance |= plane.kind == Kind::irradiance;
        const bool all_bounces =
            plane.kind == Kind::indirect || plane.kind == Kind::irradiance || plane.kind == Kind::total;
        estimation.bounces = std::max(estimation.bounces, all_bounces ? quantities.bounces : plane.bounce);
    }
    estimation.indirect = estimation.bounces > 0;
    estimation.ao_radius = quantities.ao_radius;
    estimation.ao_falloff = quantities.ao_falloff;
    estimation.indirect_radius = quantities.indirect_radius;
    estimation.exact_lights_at_first_point = !settings.antialias;
    return plan;
}

void check(const ReferenceSettings& settings) {
    const Quantities& quantities = settings.quantities;
    if (settings.samples < 2 || settings.samples % 2 != 0) {
        throw ReferenceError(
            fmt::format("{} samples per pixel: the number must be even and at least 2, one half for each "
                        "half-buffer",
                        settings.samples));
    }
    if (!(settings.target_error >= 0.0)) {
        throw ReferenceError(fmt::format("target error {} must not be negative; 0 means none", settings.target_error));
    }
    if (!(settings.minimum_separation >= 0.0f)) {
        throw ReferenceError(fmt::format("minimum separation {} m must not be negative", settings.minimum_separation));
    }
    if (!(quantities.ao_radius > 0.0f)) {
        throw ReferenceError(
            fmt::format("ao radius {} m must be positive; infinity means the whole hemisphere", quantities.ao_radius));
    }
    if (!(quantities.indirect_radius > 0.0f)) {
        throw ReferenceError(
            fmt::format("indirect radius {} m must be positive; infinity means no limit", quantities.indirect_radius));
    }
    if (quantities.bounces < 0 || quantities.bounces > most_bounces) {
        throw ReferenceError(
            fmt::format("{} bounces: the number must lie between 0 and {}", quantities.bounces, most_bounces));
    }
}

// Sample counts at which the target error is looked at: fixed, so that where a run stops does not depend on its pace.
// Each is a quarter more than the one before, which wastes at most that much.
int next_error_check(int samples) {
    int count = 16;
    while (count <= samples) count += std::max(2, count / 8 * 2);
    return count;
}
bool is_error_check(int samples) { return samples >= 2 && next_error_check(samples - 1) == samples; }

// One rendering in progress.
class ReferenceRun {
public:
    ReferenceRun(const TracedScene& scene, const EnvironmentDistribution& environment, const View& view,
                 const ReferenceSettings& settings)
        : scene_(scene),
          view_(view),
          settings_(settings),
          plan_(make_plan(settings)),
          lights_(scene, environment, settings.emitter_sampling),
          integrator_(scene, lights_, plan_.estimation),
          accumulation_(view.width(), view.height(), plan_.estimation, settings.antialias),
          hits_(first_layer(scene, view)) {
        find_exact_parts();
    }

    ReferenceResult run(const ReferenceControl& control);

private:
    void find_exact_parts();
    bool has_noise() const;
    void render_pass(int first_sample, int count);
    void render_pixel(int x, int y, int first_sample, int count, std::uint64_t& rays);
    bool reached_target() const { return is_error_check(state_.samples) && worst_error() < settings_.target_error; }
    double worst_error() const;
    ReferenceResult finish(bool complete) const;
    std::size_t pixel_index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width()) + static_cast<std::size_t>(x);
    }

    const TracedScene& scene_;
    const View& view_;
    const ReferenceSettings& settings_;
    RenderPlan plan_;
    LightTable lights_;
    PathIntegrator integrator_;
    Accumulation accumulation_;
    std::vector<SurfaceHit> hits_;
    ExactParts exact_;
    CheckpointState state_;
};

// What is the same for every sample through a pixel's centre.
void ReferenceRun::find_exact_parts() {
    if (settings_.antialias) return;
    exact_.emission.resize(hits_.size());
    if (plan_.estimation.direct) exact_.direct.resize(hits_.size());
    std::atomic<std::uint64_t> rays{hits_.size()};
    tbb::parallel_for(0, view_.height(), [&](int y) {
        std::uint64_t row_rays = 0;
        for (int x = 0; x < view_.width(); ++x) {
            const Ray ray = view_.pixel_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const std::size_t pixel = pixel_index(x, y);
            if (hits_[pixel].missed()) {
                exact_.emission[pixel] = scene_.scene().environment_radiance(ray.direction);
                continue;
            }
            const SurfacePoint point = scene_.surface_point(hits_[pixel], ray.direction);
            exact_.emission[pixel] = point.emission;
            if (plan_.estimation.direct) exact_.direct[pixel] = integrator_.exact_direct(point, row_rays);
        }
        rays += row_rays;
    });
    state_.rays = rays;
}

// False where the exact parts are everything.
bool ReferenceRun::has_noise() const {
    const EstimationPlan& plan = plan_.estimation;
    if (settings_.antialias) return !plan_.stochastic.empty();
    const bool noisy_direct = plan.direct && (lights_.has_extended_lights() || lights_.rays_find_emitters());
    return plan.ao || plan.indirect || noisy_direct;
}

void ReferenceRun::render_pixel(int x, int y, int first_sample, int count, std::uint64_t& rays) {
    const std::size_t pixel = pixel_index(x, y);
    SampleSequence sequence(settings_.seed, x, y);
    PathEstimate estimate;
    if (!settings_.antialias) {
        const SurfaceHit& hit = hits_[pixel];
        SurfacePoint point;
        if (!hit.missed()) {
            const Ray ray = view_.pixel_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            point = scene_.surface_point(hit, ray.direction);
        }
        for (int sample = first_sample; sample < first_sample + count; ++sample) {
            if (hit.missed()) {
                accumulation_.add_background(pixel, sample, {});
                continue;
            }
            sequence.start_sample(sample);
            rays += static_cast<std::uint64_t>(integrator_.estimate(point, sequence, estimate));
            accumulation_.add(pixel, sample, point.albedo, point.emission, estimate);
        }
        return;
    }
    for (int sample = first_sample; sample < first_sample + count; ++sample) {
        sequence.start_sample(sample);
        const glm::vec2 offset = sequence.point(PathIntegrator::pixel_dimension);
        const Ray ray = view_.pixel_ray(static_cast<float>(x) + offset.x, static_cast<float>(y) + offset.y);
        const float scale = depth_per_distance(view_, ray.direction);
        const SurfaceHit hit = scene_.intersect(ray.origin, ray.direction, view_.camera().near_plane / scale,
                                                view_.camera().far_plane / scale, RayCoherence::coherent);
        ++rays;
        if (hit.missed()) {
            accumulation_.add_background(pixel, sample, scene_.scene().environment_radiance(ray.direction));
            continue;
        }
        const SurfacePoint point = scene_.surface_point(hit, ray.direction);
        rays += static_cast<std::uint64_t>(integrator_.estimate(point, sequence, estimate));
        accumulation_.add(pixel, sample, point.albedo, point.emission, estimate);
    }
}

void ReferenceRun::render_pass(int first_sample, int count) {
    constexpr int tile_size = 16;
    const int columns = (view_.width() + tile_size - 1) / tile_size,
              rows = (view_.height() + tile_size - 1) / tile_size;
    std::atomic<std::uint64_t> rays{0};
    tbb::parallel_for(0, columns * rows, [&](int tile) {
        const int left = tile % columns * tile_size, top = tile / columns * tile_size;
        std::uint64_t tile_rays = 0;
        for (int y = top; y < std::min(top + tile_size, view_.height()); ++y) {
            for (int x = left; x < std::min(left + tile_size, view_.width()); ++x) {
                render_pixel(x, y, first_sample, count, tile_rays);
            }
        }
        rays += tile_rays;
    });
    state_.rays += rays;
    state_.samples += count;
}

double ReferenceRun::worst_error() const {
    double worst = 0.0;
    for (const StochasticPlane& plane : plan_.stochastic) {
        worst = std::max(worst, accumulation_.relative_error(plane, state_.samples, exact_));
    }
    return worst;
}

ReferenceResult ReferenceRun::run(const ReferenceControl& control) {
    constexpr double pass_seconds = 1.0, checkpoint_seconds = 60.0;
    const Clock::time_point start = Clock::now();
    Clock::time_point last_checkpoint = start;
    double seconds_before = 0.0;
    CheckpointKey key;
    if (!control.checkpoint.empty()) {
        key = CheckpointKey::of(scene_.scene(), view_, settings_);
        if (std::filesystem::exists(control.checkpoint)) {
            state_ = read_checkpoint(control.checkpoint, key, accumulation_.values());
            seconds_before = state_.seconds;
            if (state_.samples > settings_.samples) {
                throw ReferenceError(
                    fmt::format("checkpoint '{}' already holds {} samples per pixel, more than the {} asked "
                                "for; ask for at least as many or remove it",
                                control.checkpoint.string(), state_.samples, settings_.samples));
            }
        }
    }
    if (!has_noise()) state_.samples = settings_.samples;

    bool reached = false, stopped = false;
    double seconds_per_sample = 0.0;
    while (!stopped && state_.samples < settings_.samples) {
        if (settings_.target_error > 0.0 && (reached = reached_target())) break;
        int limit = settings_.samples;
        if (settings_.target_error > 0.0) limit = std::min(limit, next_error_check(state_.samples));
        const double affordable = seconds_per_sample > 0.0 ? pass_seconds / seconds_per_sample : 2.0;
        const int pairs = static_cast<int>(std::clamp(0.5 * affordable, 1.0, 1e6));
        const int count = std::min(2 * pairs, limit - state_.samples);

        const Clock::time_point pass_start = Clock::now();
        render_pass(state_.samples, count);
        seconds_per_sample = seconds_since(pass_start) / count;
        state_.seconds = seconds_before + seconds_since(start);

        // Told before the question whether to stop, so that whoever watches can stop the run after this very pass.
        if (control.on_progress) {
            control.on_progress({state_.samples, settings_.samples, worst_error(),
                                 static_cast<double>(state_.rays) / std::max(state_.seconds, 1e-9), state_.seconds});
        }
        stopped = control.stop && control.stop->load() && state_.samples < settings_.samples;
        if (!control.checkpoint.empty() && (stopped || seconds_since(last_checkpoint) > checkpoint_seconds)) {
            write_checkpoint(control.checkpoint, key, state_, accumulation_.values());
            last_checkpoint = Clock::now();
        }
    }
    state_.seconds = seconds_before + seconds_since(start);
    return finish(reached || !stopped);
}

ReferenceResult ReferenceRun::finish(bool complete) const {
    ReferenceResult result{Frame(view_.width(), view_.height()), state_.samples, state_.seconds, state_.rays, complete};
    for (const StochasticPlane& plane : plan_.stochastic) {
        const bool sampled = settings_.antialias || plane.kind != StochasticPlane::Kind::emission;
        if (sampled) {
            accumulation_.write(plane, state_.samples, exact_, result.frame);
        } else {
            write_gbuffer_plane(scene_, view_, nullptr, hits_, plane.name, result.frame);
        }
    }
    const View* previous = settings_.previous_view ? &*settings_.previous_view : nullptr;
    std::vector<SurfaceHit> hits = hits_;
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
                          {"samples", fmt::format("{}", state_.samples)},
                          {"seed", fmt::format("{}", settings_.seed)},
                          {"bounces", fmt::format("{}", quantities.bounces)},
                          {"ao_radius", fmt::format("{}", quantities.ao_radius)},
                          {"ao_falloff", std::string(to_string(quantities.ao_falloff))},
                          {"indirect_radius", fmt::format("{}", quantities.indirect_radius)},
                          {"minimum_separation", fmt::format("{}", settings_.minimum_separation)},
                          {"antialias", settings_.antialias ? "yes" : "no"},
                          {"rays", fmt::format("{}", state_.rays)},
                          {"seconds", fmt::format("{:.3f}", state_.seconds)}};
    return result;
}

int arena_size(int threads) {
    if (threads < 0)
        throw ReferenceError(fmt::format("{} threads: the number must not be negative; 0 means all", threads));
    return threads == 0 ? tbb::task_arena::automatic : threads;
}

}  // namespace

struct PathTracer::Implementation {
    explicit Implementation(const Scene& scene) : traced(scene), environment(scene) {}

    TracedScene traced;
    EnvironmentDistribution environment;
};

PathTracer::PathTracer(const Scene& scene) : implementation_(std::make_unique<Implementation>(scene)) {}
PathTracer::~PathTracer() = default;
PathTracer::PathTracer(PathTracer&&) noexcept = default;

ReferenceResult PathTracer::render(const View& view, const ReferenceSettings& settings,
                                   const ReferenceControl& control) const {
    check(settings);
    tbb::task_arena arena(arena_size(control.threads));
    return arena.execute([&] {
        return ReferenceRun(implementation_->traced, implementation_->environment, view, settings).run(control);
    });
}

Frame PathTracer::gbuffer(const View& view, const LayerSettings& settings, int threads) const {
    if (settings.layers < 1 || settings.layers > 99) {
        throw ReferenceError(fmt::format("{} layers: the number must lie between 1 and 99", settings.layers));
    }
    if (!(settings.minimum_separation >= 0.0f)) {
        throw ReferenceError(fmt::format("minimum separation {} m must not be negative", settings.minimum_separation));
    }
    Frame frame(view.width(), view.height());
    tbb::task_arena arena(arena_size(threads));
    arena.execute([&] {
        std::vector<SurfaceHit> hits = first_layer(implementation_->traced, view);
        for (int layer = 1; layer <= settings.layers; ++layer) {
            if (layer > 1) hits = next_layer(implementation_->traced, view, hits, settings.minimum_separation);
            const std::string prefix = layer == 1 ? "" : fmt::format("layer{}.", layer);
            for (const char* plane : {"depth", "normal", "albedo", "position", "motion", "instance", "emission"}) {
                write_gbuffer_plane(implementation_->traced, view, settings.previous_view, hits, prefix + plane, frame);
            }
        }
    });
    return frame;
}

}  // namespace plumb

#include "pathtracer/reference_plan.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "pathtracer/exact_gbuffer.h"
#include "pathtracer/motion_poses.h"
#include "pathtracer/reference_error.h"

namespace plumb {
namespace {

[[noreturn]] void refuse_plane(const std::string& plane) {
    throw ReferenceError(fmt::format(
        "the path tracer has no plane '{}'; it has ao, direct, indirect, indirect.1.., irradiance, reflection, "
        "emission, total, depth, normal, albedo, position, motion, instance, seen_before, and layer2.depth and so on",
        plane));
}

StochasticPlane stochastic_plane(const std::string& name, int bounces) {
    using Kind = StochasticPlane::Kind;
    if (name == "ao") return {name, Kind::ao, 0};
    if (name == "emission") return {name, Kind::emission, 0};
    if (name == "direct") return {name, Kind::direct, 0};
    if (name == "indirect") return {name, Kind::indirect, 0};
    if (name == "irradiance") return {name, Kind::irradiance, 0};
    if (name == "reflection") return {name, Kind::reflection, 0};
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

// The angle in radians between the orientations of two cameras.
double turn_between(const Camera& a, const Camera& b) {
    double trace = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        trace += glm::dot(glm::dvec3(a.world_from_camera[axis]), glm::dvec3(b.world_from_camera[axis]));
    }
    return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
}

// That rays and poses show what happens while the shutter is open.
void check_shutter(const TracedScene& scene, const View& opening, const View& closing) {
    if (opening.width() != closing.width() || opening.height() != closing.height()) {
        throw ReferenceError(
            fmt::format("the view at the opening of the shutter has {} x {} pixels, that at its closing {} x "
                        "{}; they must be the same",
                        opening.width(), opening.height(), closing.width(), closing.height()));
    }
    const double turn = glm::degrees(turn_between(opening.camera(), closing.camera()));
    if (!(turn < 90.0)) {
        throw ReferenceError(fmt::format(
            "camera '{}' turns by {:.1f} degrees while the shutter is open, but primary rays go straight from one view "
            "to the other, which shows no turn of 90 degrees or more; open the shutter for a shorter time",
            closing.camera().name, turn));
    }
    for (const Instance& instance : scene.scene().instances) {
        if (poses_over(instance, scene.span()) <= most_poses) continue;
        throw ReferenceError(
            fmt::format("instance '{}' turns by more than {} turns while the shutter is open, or would at its fastest, "
                        "which is more than its {} poses show; open the shutter for a shorter time",
                        instance.name, (most_poses - 1) / poses_per_turn, most_poses));
    }
}

void check(const TracedScene& scene, const View& view, const ReferenceSettings& settings) {
    const Quantities& quantities = settings.quantities;
    if (settings.first_sample < 0 || settings.first_sample % 2 != 0 || settings.first_sample >= settings.samples) {
        throw ReferenceError(
            fmt::format("first sample {} of {}: the number must be even, not negative, and below the last",
                        settings.first_sample, settings.samples));
    }
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
    for (const auto& [name, radius] :
         {std::pair{"indirect", quantities.indirect_radius}, std::pair{"reflection", quantities.reflection_radius}}) {
        if (radius > 0.0f) continue;
        throw ReferenceError(fmt::format("{} radius {} m must be positive; infinity means no limit", name, radius));
    }
    if (quantities.bounces < 0 || quantities.bounces > most_diffuse_bounces) {
        throw ReferenceError(
            fmt::format("{} bounces: the number must lie between 0 and {}", quantities.bounces, most_diffuse_bounces));
    }
    if (settings.roulette_after < 0) {
        throw ReferenceError(fmt::format("roulette after {} bounces: the number must not be negative; 0 means never",
                                         settings.roulette_after));
    }
    if (settings.oracle && (settings.oracle->layers < 0 || settings.oracle->layers > 99 ||
                            !(settings.oracle->minimum_separation >= 0.0f))) {
        throw ReferenceError(
            fmt::format("an oracle of {} layers that lie {} m apart: there may be 1 to 99, or 0 for all in view, and "
                        "the separation must not be negative",
                        settings.oracle->layers, settings.oracle->minimum_separation));
    }
    const std::optional<View>& opening = settings.view_at_shutter_opening;
    if (settings.oracle && opening) {
        throw ReferenceError(
            "an oracle knows the layers of one moment, but the shutter is open for longer; close the shutter, or leave "
            "the oracle out");
    }
    if (opening) check_shutter(scene, *opening, view);
}

}  // namespace

RenderPlan make_plan(const TracedScene& scene, const View& view, const ReferenceSettings& settings) {
    check(scene, view, settings);
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
        // A scene without a specular lobe or a pane reflects nothing; its plane is black at no cost.
        estimation.reflection |= (plane.kind == Kind::reflection || plane.kind == Kind::total) &&
                                 (scene.has_specular_lobes() || scene.has_transparency());
        const bool all_bounces =
            plane.kind == Kind::indirect || plane.kind == Kind::irradiance || plane.kind == Kind::total;
        estimation.bounces = std::max(estimation.bounces, all_bounces ? quantities.bounces : plane.bounce);
    }
    estimation.indirect = estimation.bounces > 0;
    if (estimation.reflection) estimation.bounces = std::max(estimation.bounces, quantities.bounces);
    estimation.ao_radius = quantities.ao_radius;
    estimation.ao_falloff = quantities.ao_falloff;
    estimation.indirect_radius = quantities.indirect_radius;
    estimation.indirect_falloff = quantities.indirect_falloff;
    estimation.reflection_radius = quantities.reflection_radius;
    estimation.reflection_falloff = quantities.reflection_falloff;
    estimation.roulette_after = settings.roulette_after;
    plan.primary_rays_are_sampled =
        settings.antialias || view.camera().aperture_radius > 0.0f || settings.view_at_shutter_opening.has_value();
    estimation.exact_lights_at_first_point = !plan.primary_rays_are_sampled;
    return plan;
}

}  // namespace plumb

#include "experiments/view_truths.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace plumb {
namespace {

void add_plane(std::vector<std::string>& planes, const std::string& plane) {
    if (std::ranges::find(planes, plane) == planes.end()) planes.push_back(plane);
}

ReferenceSettings base_settings(const Experiment& experiment, const ExperimentScene& scene) {
    ReferenceSettings settings;
    settings.quantities = experiment.quantities;
    settings.quantities.ao_radius = scene.ao_radius;
    settings.samples = experiment.reference.samples;
    settings.target_error = experiment.reference.target_error;
    settings.seed = experiment.reference.seed;
    settings.antialias = experiment.reference.antialias;
    settings.minimum_separation = scene.minimum_separation;
    return settings;
}

}  // namespace

bool has_limited_truth(const std::string& plane) { return plane.starts_with("indirect") || plane == "irradiance"; }

bool uses_truth(const Method& method) {
    return method.gbuffer.source == SourceOfStage::truth || method.direct.source == SourceOfStage::truth;
}

std::string full_truth_name(const std::string& plane) {
    return has_limited_truth(plane) || plane == "total" ? "full" : "";
}

ReferenceSettings full_truth_settings(const Experiment& experiment, const ExperimentScene& scene) {
    ReferenceSettings settings = base_settings(experiment, scene);
    settings.quantities.planes = experiment.planes;
    for (const Method& method : experiment.methods) {
        if (!uses_truth(method)) continue;
        for (const char* plane : {"depth", "normal", "albedo", "direct", "emission"}) {
            add_plane(settings.quantities.planes, plane);
        }
        if (method.gbuffer.layers < 2) continue;
        for (const char* plane : {"layer2.depth", "layer2.normal", "layer2.albedo"}) {
            add_plane(settings.quantities.planes, plane);
        }
    }
    return settings;
}

std::optional<ReferenceSettings> limited_truth_settings(const Experiment& experiment, const ExperimentScene& scene) {
    ReferenceSettings settings = base_settings(experiment, scene);
    settings.quantities.indirect_radius = scene.indirect_radius;
    std::ranges::copy_if(experiment.planes, std::back_inserter(settings.quantities.planes), has_limited_truth);
    if (settings.quantities.planes.empty() || std::isinf(scene.indirect_radius)) return std::nullopt;
    return settings;
}

std::vector<Truth> ViewTruths::of(const std::string& plane) const {
    const bool two = limited && has_limited_truth(plane);
    std::vector<Truth> truths = {{full_truth_name(plane), plane, &full.frame, full.samples}};
    if (two) truths.push_back({fmt::format("within {} m", limit), plane, &limited->frame, limited->samples});
    return truths;
}

}  // namespace plumb

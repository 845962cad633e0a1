#include "experiments/oracle_images.h"

#include <algorithm>
#include <iterator>

#include "metrics/referenced_error.h"

namespace plumb {
namespace {

// The planes of one rendering. Empty where it is not complete.
std::vector<PlaneImage> render_planes(const std::string& place, const ReferenceSettings& settings,
                                      const std::string& name, OracleLimits limits, const OracleRender& render) {
    std::vector<PlaneImage> images;
    ReferenceResult result = render(settings, name);
    if (!result.complete) return images;
    for (const std::string& plane : settings.quantities.planes) {
        PlaneImage& image = images.emplace_back(PlaneImage{place, plane, name, std::move(result.frame.plane(plane))});
        image.oracle = limits;
        image.halves = {std::move(result.frame.plane(half_a_of(plane))),
                        std::move(result.frame.plane(half_b_of(plane)))};
    }
    return images;
}

}  // namespace

std::vector<PlaneImage> oracle_images(const Experiment& experiment, const ExperimentScene& entry,
                                      const std::string& place, const View& view, ReferenceSettings settings,
                                      const Frame& truth, const OracleRender& render) {
    std::vector<PlaneImage> images;
    std::vector<std::string>& planes = settings.quantities.planes;
    planes = experiment.planes;
    std::erase_if(planes, [&](const std::string& plane) { return !has_halves(truth, plane); });
    if (planes.empty()) return images;
    // False where the rendering is not complete.
    const auto add = [&](const std::string& name, OracleLimits limits) {
        std::vector<PlaneImage> made = render_planes(place, settings, name, limits, render);
        std::ranges::move(made, std::back_inserter(images));
        return !made.empty();
    };
    for (const int layers : experiment.oracle_layers) {
        settings.oracle = OracleSettings{view, layers, entry.minimum_separation};
        if (!add(oracle_name(layers), {.layers = layers})) return images;
    }
    settings.oracle.reset();
    std::erase_if(planes, [](const std::string& plane) { return !has_light_of_bounces(plane); });
    if (planes.empty()) return images;
    for (const int bounces : experiment.oracle_bounces) {
        settings.quantities.bounces = bounces;
        if (!add(oracle_name_of_bounces(bounces), {.bounces = bounces})) return images;
    }
    return images;
}

}  // namespace plumb

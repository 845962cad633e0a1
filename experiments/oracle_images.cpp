#include "experiments/oracle_images.h"

#include "metrics/referenced_error.h"

namespace plumb {

std::vector<PlaneImage> oracle_images(const Experiment& experiment, const ExperimentScene& entry,
                                      const std::string& place, const View& view, ReferenceSettings settings,
                                      const Frame& truth, const OracleRender& render) {
    std::vector<PlaneImage> images;
    settings.quantities.planes = experiment.planes;
    std::erase_if(settings.quantities.planes, [&](const std::string& plane) { return !has_halves(truth, plane); });
    if (settings.quantities.planes.empty()) return images;
    for (const int layers : experiment.oracle_layers) {
        settings.oracle = OracleSettings{view, layers, entry.minimum_separation};
        const std::string name = oracle_name(layers);
        ReferenceResult result = render(settings, name);
        if (!result.complete) break;
        for (const std::string& plane : settings.quantities.planes) {
            PlaneImage& image =
                images.emplace_back(PlaneImage{place, plane, name, std::move(result.frame.plane(plane))});
            image.oracle_layers = layers;
            image.halves = {std::move(result.frame.plane(half_a_of(plane))),
                            std::move(result.frame.plane(half_b_of(plane)))};
        }
    }
    return images;
}

}  // namespace plumb

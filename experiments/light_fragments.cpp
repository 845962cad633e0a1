#include "experiments/light_fragments.h"

#include <algorithm>
#include <map>
#include <utility>

#include "rasterizer/light_fragment_count.h"

namespace plumb {

void add_light_fragments(const Experiment& experiment, const SceneFinder& finder, GlBackend backend,
                         std::vector<Cell>& cells) {
    const std::unique_ptr<GlContext> context = GlContext::create(backend);
    for (const ExperimentScene& entry : experiment.scenes) {
        const Scene scene = finder.load(entry.scene);
        std::map<std::pair<std::string, std::string>, double> counted;  // by view and method
        for (Cell& cell : cells) {
            const Method* method = find_method(experiment.methods, cell.method);
            const auto camera = std::ranges::find(scene.cameras, cell.place, &Camera::name);
            if (cell.scene != entry.scene || !method || camera == scene.cameras.end()) continue;
            const auto key = std::pair(cell.place, cell.method);
            if (!counted.contains(key)) {
                counted[key] = static_cast<double>(
                    count_light_fragments(*context, scene, method_in_scene(*method, entry, experiment.file.string()),
                                          View(*camera, experiment.width, experiment.height)));
            }
            cell.set(std::string(light_fragments_measure), counted[key]);
        }
    }
}

}  // namespace plumb

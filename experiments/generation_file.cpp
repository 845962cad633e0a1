#include <algorithm>

#include "experiments/config_values.h"
#include "experiments/experiment_file.h"
#include "experiments/generation.h"

namespace plumb {

GenerationExperiment parse_generation(const ConfigValue& table, const std::filesystem::path& file) {
    ConfigReader reader(table, file.string());
    GenerationExperiment experiment;
    reader.text("kind", "generation");
    experiment.file = file;
    experiment.name = reader.text("name", file.stem().string());
    experiment.title = reader.text("title", experiment.name);
    experiment.question = reader.text("question", "");
    read_resolution(reader, experiment.width, experiment.height);
    experiment.frames = reader.integer("frames", experiment.frames, 2, 100000);
    experiment.frames_per_second = reader.number("frames_per_second", experiment.frames_per_second, 1e-3, 1e4);
    for (ConfigReader& entry : reader.tables("walks")) {
        GenerationWalk walk;
        walk.name = entry.required_text("name");
        walk.scene = entry.required_text("scene");
        walk.path = entry.required_text("path");
        walk.start = entry.number("start", walk.start, -1e6, 1e6);
        walk.camera_speed = entry.number("camera_speed", walk.camera_speed, 0.0, 1e6);
        walk.object_speed = entry.number("object_speed", walk.object_speed, 0.0, 1e6);
        walk.minimum_separation =
            static_cast<float>(entry.number("minimum_separation", walk.minimum_separation, 0.0, 1e6));
        entry.finish();
        experiment.walks.push_back(walk);
    }
    if (experiment.walks.empty()) reader.fail("", "'walks' is missing: write at least one [[walks]] table");
    allow_presentation(reader);
    experiment.methods = read_methods(reader, {"layer2.depth"}).methods;
    for (const Method& method : experiment.methods) {
        if (method.gbuffer.layers != 2 || method.gbuffer.source == SourceOfStage::truth ||
            method.gbuffer.separation_unit != SeparationUnit::metres) {
            reader.fail("methods", "all must render two layers, a separation in metres apart: '" + method.name +
                                       "' does not; set its gbuffer.layers, .source and .separation_unit");
        }
    }
    reader.finish();
    return experiment;
}

void make_quick(GenerationExperiment& experiment) {
    experiment.width = std::max(8, experiment.width / 4);
    experiment.height = std::max(8, experiment.height / 4);
    experiment.frames = std::min(experiment.frames, 4);
}

}  // namespace plumb

#include "experiments/reproduction_key.h"

#include <fmt/format.h>

#include "experiments/experiment_file.h"
#include "experiments/generation.h"
#include "experiments/program_checksum.h"

namespace plumb {

const std::string& SceneHashes::of(const std::string& scene, LoadedScenes& scenes) {
    const auto [place, is_new] = hashes_.try_emplace(scene);
    if (is_new) {
        try {
            place->second = fmt::format("{:016x}", scenes.load(scene).content_hash());
        } catch (const std::exception&) {
            place->second = "not here";
        }
    }
    return place->second;
}

std::string measuring_key(const Reproduction& reproduction, SceneHashes& hashes, LoadedScenes& scenes,
                          GlBackend backend, bool quick) {
    static const std::string program = program_checksum();
    std::string key = fmt::format("{}; program {}; OpenGL {}; {}", reproduction.text, program, to_string(backend),
                                  quick ? "quick" : "whole");
    const auto add_methods = [&](const MethodList& methods) {
        for (const Method& method : methods) key += fmt::format("; {} {:016x}", method.name, method_hash(method));
    };
    if (!reproduction.drawings.empty()) return text_checksum(key);
    if (kind_of(reproduction.table, reproduction.file) == ExperimentKind::generation) {
        const GenerationExperiment experiment = parse_generation(reproduction.table, reproduction.file);
        for (const GenerationWalk& walk : experiment.walks) key += fmt::format("; {}", hashes.of(walk.scene, scenes));
        add_methods(experiment.methods);
    } else {
        const Experiment experiment = parse_experiment(reproduction.table, reproduction.file);
        for (const ExperimentScene& entry : experiment.scenes)
            key += fmt::format("; {}", hashes.of(entry.scene, scenes));
        add_methods(experiment.methods);
    }
    return text_checksum(key);
}

}  // namespace plumb

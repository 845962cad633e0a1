#include "experiments/convergence_file.h"

#include <algorithm>

#include <fmt/format.h>

#include "experiments/config_values.h"

namespace plumb {
namespace {

// What has noise; all of a G-buffer is exact.
const std::vector<std::string> noisy_planes = {"ao",         "direct",     "indirect",   "indirect.1", "indirect.2",
                                               "indirect.3", "irradiance", "reflection", "total"};

ConvergenceScene read_scene(ConfigReader& reader) {
    ConvergenceScene scene;
    scene.scene = reader.required_text("scene");
    scene.view = reader.text("view", "");
    scene.ao_radius = static_cast<float>(reader.number("ao_radius", scene.ao_radius, 1e-6, no_limit));
    reader.finish();
    return scene;
}

}  // namespace

ConvergenceExperiment parse_convergence(const ConfigValue& table, const std::filesystem::path& file) {
    ConfigReader reader(table, file.string());
    ConvergenceExperiment experiment;
    reader.text("kind", "convergence");
    experiment.file = file;
    experiment.name = reader.text("name", file.stem().string());
    experiment.title = reader.text("title", experiment.name);
    experiment.question = reader.text("question", "");
    experiment.planes = reader.texts("planes", experiment.planes);
    if (experiment.planes.empty()) reader.fail("planes", "must name at least one plane");
    for (const std::string& plane : experiment.planes) {
        if (std::ranges::find(noisy_planes, plane) == noisy_planes.end())
            reader.fail("planes", fmt::format("no plane '{}' with noise{}", plane, name_hint(plane, noisy_planes)));
    }
    read_resolution(reader, experiment.width, experiment.height);
    experiment.quantities.bounces = reader.integer("bounces", experiment.quantities.bounces, 1, most_diffuse_bounces);
    read_falloff(reader, "ao_falloff", experiment.quantities.ao_falloff);

    experiment.samples = reader.integers("samples", experiment.samples, 2, 1 << 20);
    const bool ascend =
        std::ranges::adjacent_find(experiment.samples, std::greater_equal()) == experiment.samples.end();
    const bool even = std::ranges::all_of(experiment.samples, [](int samples) { return samples % 2 == 0; });
    if (experiment.samples.size() < 3 || !ascend || !even)
        reader.fail("samples", "must be three or more even numbers that ascend: a slope is fitted to them");
    experiment.seeds = reader.integer("seeds", experiment.seeds, 2, 1000);
    experiment.reference_samples = reader.integer("reference_samples", experiment.reference_samples, 2, 1 << 24);
    if (experiment.reference_samples % 2 != 0)
        reader.fail("reference_samples", "must be even, because the reference keeps two halves");
    experiment.most_noise = reader.number("most_noise", experiment.most_noise, 1e-6, 1e6);

    for (ConfigReader& scene : reader.tables("scenes")) experiment.scenes.push_back(read_scene(scene));
    if (experiment.scenes.empty()) reader.fail("", "'scenes' is missing: write at least one [[scenes]] table");
    reader.finish();
    return experiment;
}

void make_quick(ConvergenceExperiment& experiment) {
    experiment.width = std::max(8, experiment.width / 2);
    experiment.height = std::max(8, experiment.height / 2);
    experiment.seeds = 2;
    experiment.reference_samples = std::min(experiment.reference_samples, 1024);
    while (experiment.samples.size() > 3 && experiment.samples.back() > 64) experiment.samples.pop_back();
}

}  // namespace plumb

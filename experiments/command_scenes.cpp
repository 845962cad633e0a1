// `plumbline scenes`: what there is to see.
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/command.h"
#include "experiments/exit_code.h"
#include "experiments/progress_line.h"
#include "experiments/scene_finder.h"
#include "experiments/terminal_table.h"
#include "scenes/effects.h"

namespace plumb {
namespace {

std::vector<std::string> light_list(const Scene& scene) {
    std::vector<std::string> lights;
    const auto add = [&](std::size_t count, const char* kind) {
        if (count > 0) lights.push_back(fmt::format("{} {}", count, kind));
    };
    add(scene.point_lights.size(), "point");
    add(scene.spot_lights.size(), "spot");
    add(scene.directional_lights.size(), "directional");
    std::size_t emissive = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (scene.materials[static_cast<std::size_t>(mesh.material)].is_emissive()) emissive += mesh.triangles.size();
    }
    add(emissive, "emissive triangles");
    if (!scene.environment.is_black()) lights.emplace_back(scene.environment.texture < 0 ? "constant sky" : "sky map");
    return lights;
}

std::string names_of(const auto& elements) {
    std::string names;
    for (const auto& element : elements) names.append(names.empty() ? "" : ", ").append(element.name);
    return names.empty() ? "none" : names;
}

int list_scenes(const SceneFinder& finder) {
    using Align = TerminalTable::Align;
    TerminalTable table({{"scene"}, {"from"}, {"triangles", Align::right}, {"lights"}, {"views"}, {"paths"}});
    const std::vector<FoundScene> scenes = finder.list();
    std::vector<std::string> absent, problems;
    ProgressLine progress;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const FoundScene& found = scenes[i];
        progress.show(static_cast<double>(i) / static_cast<double>(scenes.size()), found.name);
        try {
            const Scene scene = finder.load(found.name);
            const auto lights = light_list(scene);
            table.add_row({found.name, found.from, fmt::format("{}", scene.triangle_count()),
                           lights.empty() ? "none" : fmt::format("{}", fmt::join(lights, ", ")),
                           names_of(scene.cameras), names_of(scene.paths)});
        } catch (const std::exception& error) {
            // A wrapper whose mesh is not here is nothing wrong: the mesh is not part of the program.
            (found.from == "wrapper" ? absent : problems).push_back(fmt::format("{}: {}", found.name, error.what()));
        }
    }
    progress.clear();
    fmt::print("{}", table.print());
    if (!absent.empty()) fmt::print("\nknown, but their meshes are not here:\n  {}\n", fmt::join(absent, "\n  "));
    if (!problems.empty()) fmt::print("\ncannot be loaded:\n  {}\n", fmt::join(problems, "\n  "));
    return problems.empty() ? exit_fine : exit_wrong_use;
}

int show_scene(const SceneFinder& finder, const std::string& name) {
    const Scene scene = finder.load(name);
    const Bounds bounds = scene.bounds();
    const auto lights = light_list(scene);
    fmt::print("{}\n{}\n\n", scene.name, scene.description);
    fmt::print("triangles   {} in {} instances of {} meshes\n", scene.triangle_count(), scene.instances.size(),
               scene.meshes.size());
    fmt::print("materials   {}, {} textures\n", scene.materials.size(), scene.textures.size());
    if (!bounds.empty()) {
        fmt::print("bounds      ({:.3g}, {:.3g}, {:.3g}) to ({:.3g}, {:.3g}, {:.3g}) m\n", bounds.lower.x,
                   bounds.lower.y, bounds.lower.z, bounds.upper.x, bounds.upper.y, bounds.upper.z);
    }
    fmt::print("lights      {}\n", lights.empty() ? "none" : fmt::format("{}", fmt::join(lights, ", ")));
    std::vector<std::string> effects;
    for (const Effect& effect : plan_effects(scene).effects) {
        if (effect.on) effects.emplace_back(to_string(effect.kind));
    }
    fmt::print("calls for   {}\n", effects.empty() ? "no effects" : fmt::format("{}", fmt::join(effects, ", ")));
    fmt::print("hash        {:016x}\n\nviews\n", scene.content_hash());
    for (const Camera& camera : scene.cameras) {
        const glm::vec3 eye = camera.position();
        fmt::print("  {:<14} at ({:.3g}, {:.3g}, {:.3g}), {:.1f} degrees high, {:.3g} to {:.3g} m\n", camera.name,
                   eye.x, eye.y, eye.z, glm::degrees(camera.vertical_fov), camera.near_plane, camera.far_plane);
    }
    fmt::print("paths\n");
    for (const CameraPath& path : scene.paths) {
        fmt::print("  {:<14} {} keys, {:.3g} s\n", path.name, path.keys.size(), path.duration());
    }
    if (!scene.import_notes.empty()) fmt::print("on the way in\n");
    for (const std::string& note : scene.import_notes) fmt::print("  {}\n", note);
    return exit_fine;
}

}  // namespace

void add_scenes_command(CLI::App& app, const CommonOptions& common, Action& action) {
    CLI::App* command = app.add_subcommand("scenes", "List scenes, or show one in detail")->group("Look around");
    auto name = std::make_shared<std::string>();
    command->add_option("name", *name, "Scene to show: built in, of the scenes folder, or a file")->type_name("SCENE");
    command->footer("Examples:\n  plumbline scenes\n  plumbline scenes cornell\n  plumbline scenes models/hall.gltf");
    command->callback([name, &common, &action] {
        action = [name, &common] {
            const SceneFinder finder(common.scenes_dirs);
            return name->empty() ? list_scenes(finder) : show_scene(finder, *name);
        };
    });
}

}  // namespace plumb

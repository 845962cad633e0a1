// `plumbline reference`: the path-traced planes of one view.
#include <cstdint>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/command.h"
#include "experiments/exit_code.h"
#include "experiments/interruption.h"
#include "experiments/pictures.h"
#include "experiments/progress_line.h"
#include "experiments/reference_cache.h"
#include "experiments/scene_finder.h"
#include "experiments/view_options.h"
#include "pathtracer/reference.h"

namespace plumb {
namespace {

constexpr const char* examples = R"(Examples:
  plumbline reference cornell --samples 1024
  plumbline reference colonnade --view court --target-error 0.01 --planes ao,indirect,total
  plumbline reference sponza.toml --seed 7 --threads 4 --output out/sponza
Ctrl-C leaves a checkpoint beside the files; the same command resumes it.)";

struct Options {
    ViewOptions view;
    ReferenceSettings settings;
    int threads = 0;
};

int render(const Options& options, const CommonOptions& common) {
    const Scene scene = SceneFinder(common.scenes_dirs).load(options.view.scene);
    const View view = options.view.make_view(scene);
    ReferenceSettings settings = options.settings;
    settings.quantities = options.view.read_quantities();

    ProgressLine progress;
    ReferenceControl control;
    control.threads = options.threads;
    control.stop = &interruption_flag();
    // The checkpoint's name holds the key's hash: other settings never resume it.
    control.checkpoint =
        options.view.output /
        ReferenceCache("").file_of(reference_key(scene, view, settings)).filename().replace_extension(".partial");
    std::filesystem::create_directories(options.view.output);
    control.on_progress = [&](const ReferenceProgress& done) {
        progress.show(static_cast<double>(done.samples_done) / std::max(1, done.samples_wanted),
                      fmt::format("{} of {} samples, {:.2f} M rays/s, relative error {:.3g}", done.samples_done,
                                  done.samples_wanted, done.rays_per_second * 1e-6, done.relative_error));
    };
    ReferenceResult result = PathTracer(scene).render(view, settings, control);
    progress.clear();
    if (!result.complete) {
        fmt::print("Interrupted after {} samples per pixel; the same command resumes from '{}'\n", result.samples,
                   control.checkpoint.string());
        return exit_interrupted;
    }
    fmt::print("{} / {}: {} samples per pixel, {:.1f} s, {:.2f} M rays/s\n", options.view.scene, view.camera().name,
               result.samples, result.seconds,
               result.seconds > 0 ? static_cast<double>(result.rays) / result.seconds * 1e-6 : 0.0);
    result.frame.facts["scene"] = options.view.scene;
    result.frame.facts["view"] = view.camera().name;
    result.frame.facts["samples"] = fmt::format("{}", result.samples);
    write_frame_files(result.frame, options.view, view.camera().name, "reference");
    std::filesystem::remove(control.checkpoint);
    return exit_fine;
}

}  // namespace

void add_reference_command(CLI::App& app, const CommonOptions& common, Action& action) {
    CLI::App* command = app.add_subcommand("reference", "Path trace one view: the truth")->group("Render");
    auto options = std::make_shared<Options>();
    options->view.add_to(*command, {"ao", "direct", "indirect", "total"});
    const auto even = [](const std::string& text) {
        return text.empty() || (text.back() - '0') % 2 == 0 ? std::string()
                                                            : "must be even, because the reference keeps two halves";
    };
    command
        ->add_option("--samples", options->settings.samples, "Samples per pixel (even), the most with a target error")
        ->check(CLI::Range(2, 1 << 24))
        ->check(CLI::Validator(even, "EVEN"))
        ->capture_default_str();
    command->add_option("--target-error", options->settings.target_error, "Stop below this relative standard error")
        ->check(CLI::Range(0.0, 1.0));
    command->add_option("--seed", options->settings.seed, "Seed of the samples")->capture_default_str();
    command
        ->add_option("--separation", options->settings.minimum_separation,
                     "Metres between the layers, for layer2.* planes")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command->add_flag("--antialias", options->settings.antialias, "Spread primary rays over the pixel");
    command->add_option("--threads", options->threads, "Threads; 0: all")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command->footer(examples);
    command->callback(
        [options, &common, &action] { action = [options, &common] { return render(*options, common); }; });
}

}  // namespace plumb

// `plumbline reference`: the path-traced planes of one view, in one run or in shards that are merged.
#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/command.h"
#include "experiments/exit_code.h"
#include "experiments/interruption.h"
#include "experiments/progress_line.h"
#include "experiments/reference_cache.h"
#include "experiments/reference_options.h"
#include "pathtracer/reference_error.h"

namespace plumb {
namespace {

constexpr const char* reference_examples = R"(Examples:
  plumbline reference cornell --samples 1024
  plumbline reference colonnade --view court --target-error 0.01 --planes ao,indirect,total
  plumbline reference sponza.toml --seed 7 --threads 4 --output out/sponza
Shards, on as many machines as there are; merged, they have the bits of one run:
  plumbline reference cornell --samples 0..512
  plumbline reference cornell --samples 512..1024
  plumbline reference cornell --merge out/cornell_front.*.shard
The best that any method could make of two layers, and of all that is in view:
  plumbline reference clutter --planes ao,indirect --oracle 2 --oracle-guard-band 64 --separation 0.05
  plumbline reference clutter --planes ao,indirect --oracle 0
Motion blur along a camera path:
  plumbline reference cornell --path strafe --shutter 0.5..0.52

Ctrl-C and SIGTERM leave a checkpoint beside the files, as does every minute; the same command resumes it.)";

std::string million_rays_per_second(std::uint64_t rays, double seconds) {
    return fmt::format("{:.2f} M rays/s", seconds > 0.0 ? static_cast<double>(rays) / seconds * 1e-6 : 0.0);
}

// "standard error: ao 0.61 %, indirect 2.0 %"
void print_error_bars(const Frame& frame, const std::vector<std::string>& planes) {
    std::string text;
    for (const std::string& plane : planes) {
        if (!frame.has("variance." + plane)) continue;
        text += fmt::format("{}{} {:.2g} %", text.empty() ? "" : ", ", plane,
                            100.0 * relative_standard_error(frame, plane));
    }
    if (!text.empty()) fmt::print("standard error: {}\n", text);
}

// One reference on its way: the scene at its time, the view, and the settings.
struct Task {
    Task(const ReferenceOptions& given, const CommonOptions& common)
        : options(given),
          scene(given.view.load(SceneFinder(common.scenes_dirs))),
          view(given.view.make_view(scene)),
          settings(given.settings_for(scene, view)) {}

    // The name holds the key's hash: other settings never resume it.
    std::filesystem::path checkpoint() const {
        const std::string key = reference_key(scene, view, settings, options.span);
        return options.view.output / ReferenceCache("").file_of(key).filename().replace_extension(".partial");
    }

    void write(ReferenceResult result) const {
        print_error_bars(result.frame, settings.quantities.planes);
        if (!result.exact) {
            fmt::print(stderr,
                       "warning: a pixel is so much brighter than the lights would have it that its sum was rounded; "
                       "another split into shards may differ in last bits\n");
        }
        result.frame.facts["scene"] = options.view.scene;
        result.frame.facts["view"] = view.camera().name;
        if (options.has_shutter) {
            result.frame.facts["shutter"] = fmt::format("{}..{}", options.span.begin, options.span.end);
        }
        write_frame_files(result.frame, options.view, view.camera().name, "reference");
    }

    // Large frames need the memory of what they are rendered from.
    void forget_scene() { scene = {}; }

    std::string name() const { return fmt::format("{} / {}", options.view.scene, view.camera().name); }

    const ReferenceOptions& options;
    Scene scene;
    View view;
    ReferenceSettings settings;
};

int interrupted(const std::filesystem::path& checkpoint) {
    fmt::print("the same command resumes from '{}'\n", checkpoint.string());
    return exit_interrupted;
}

int render(const ReferenceOptions& options, const CommonOptions& common) {
    if (options.is_shard && options.settings.target_error > 0.0) {
        throw ReferenceError(
            "--target-error does not go with a shard: where it stops depends on all samples; leave it away");
    }
    const std::atomic<bool>& stop = interruption_flag();
    require_writable_folder(options.view.output);
    Task task(options, common);

    ProgressLine progress;
    ReferenceControl control;
    control.threads = options.threads;
    control.stop = &stop;
    control.checkpoint = task.checkpoint();
    int samples_done = 0;
    control.on_progress = [&](const ReferenceProgress& done) {
        samples_done = done.samples_done;
        progress.show(static_cast<double>(done.samples_done) / std::max(1, done.samples_wanted),
                      fmt::format("{} of {} samples, {:.2f} M rays/s, relative error {:.3g}", done.samples_done,
                                  done.samples_wanted, done.rays_per_second * 1e-6, done.relative_error));
    };
    std::optional<PathTracer> tracer(std::in_place, task.scene, options.span);
    if (options.is_shard) {
        const std::filesystem::path file = options.shard_file(task.view);
        const bool complete = tracer->render_shard(task.view, task.settings, file, control);
        progress.clear();
        if (!complete) {
            fmt::print("Interrupted after {} samples per pixel of the shard; ", samples_done);
            return interrupted(control.checkpoint);
        }
        std::filesystem::remove(control.checkpoint);
        fmt::print(
            "{}: samples {} to {} per pixel\n{}\nOnce there are shards from sample 0 to the last, merge them:\n"
            "  {}\n",
            task.name(), task.settings.first_sample, task.settings.samples - 1, file.string(),
            merge_command(common.arguments, options, task.view));
        return exit_fine;
    }

    SampledReference sampled = tracer->sample(task.view, task.settings, control);
    tracer.reset();
    task.forget_scene();
    ReferenceResult result = std::move(sampled).result();
    progress.clear();
    if (!result.complete) {
        fmt::print("Interrupted after {} samples per pixel; ", result.samples);
        return interrupted(control.checkpoint);
    }
    fmt::print("{}: {} samples per pixel, {:.1f} s, {}\n", task.name(), result.samples, result.seconds,
               million_rays_per_second(result.rays, result.seconds));
    task.write(std::move(result));
    std::filesystem::remove(control.checkpoint);
    return exit_fine;
}

int merge(const ReferenceOptions& options, const CommonOptions& common) {
    require_writable_folder(options.view.output);
    Task task(options, common);
    try {
        SampledReference sampled =
            PathTracer(task.scene, options.span).merge(task.view, task.settings, options.merge, options.threads);
        task.forget_scene();
        ReferenceResult result = std::move(sampled).result();
        fmt::print("{}: {} samples per pixel of {} shards, {:.1f} s, {}\n", task.name(), result.samples,
                   options.merge.size(), result.seconds, million_rays_per_second(result.rays, result.seconds));
        task.write(std::move(result));
    } catch (const ReferenceError& error) {
        throw ReferenceError(fmt::format(
            "{}\n(--merge wants the scene, view, size, planes and all other options that the shards were rendered "
            "with, but --samples; nothing was written)",
            error.what()));
    }
    return exit_fine;
}

}  // namespace

void add_reference_command(CLI::App& app, const CommonOptions& common, Action& action) {
    CLI::App* command = app.add_subcommand("reference", "Path trace one view: the truth")->group("Render");
    auto options = std::make_shared<ReferenceOptions>();
    options->add_to(*command);
    command->footer(reference_examples);
    command->callback([options, &common, &action] {
        action = [options, &common] {
            return options->merge.empty() ? render(*options, common) : merge(*options, common);
        };
    });
}

}  // namespace plumb

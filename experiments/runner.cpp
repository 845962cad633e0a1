#include "experiments/runner.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <iterator>

#include <fmt/format.h>

#include "experiments/ladder.h"
#include "experiments/path_run.h"
#include "experiments/pictures.h"
#include "experiments/result_files.h"
#include "experiments/scene_run.h"
#include "experiments/summary.h"

namespace plumb {
namespace {

void describe_context(const GlInfo& info, RunResults& results) {
    results.gl_backend = fmt::format("{} ({})", to_string(info.backend), info.platform);
    results.gl_vendor = info.vendor, results.gl_renderer = info.renderer, results.gl_version = info.version;
    results.gl_software = info.software;
}

// Its views, then its camera paths.
void run_scene(const Experiment& experiment, const ExperimentScene& entry, const Scene& scene,
               const RunOptions& options, SceneRunControl control, RunResults& results) {
    results.scene_hashes[entry.scene] = fmt::format("{:016x}", scene.content_hash());
    // A frame of a path takes about as long as a view.
    const auto views = static_cast<double>(views_of(entry, scene).size());
    double frames = views;
    for (const ExperimentPath& path : entry.paths) frames += path.frames;
    const ProgressPart all = control.part;
    control.part = all.part(0.0, views / frames);
    {
        SceneRun run(experiment, entry, scene, control);
        run.run(results);
        write_pictures(run, experiment, entry.scene, options.output, results);
        if (options.write_frames) write_frames(run, experiment, entry.scene, options.output);
    }
    double done = views;
    for (const ExperimentPath& path : entry.paths) {
        if (options.stop && options.stop->load()) return;
        control.part = all.part(done / frames, (done + path.frames) / frames);
        done += path.frames;
        try {
            PathRun(experiment, entry, scene, path, control, options.output).run(results);
        } catch (const std::exception& error) {
            results.failures.push_back({fmt::format("{} / {}", entry.scene, path.path), error.what()});
        }
    }
}

}  // namespace

RunResults run_experiment(const Experiment& experiment, LoadedScenes& scenes, const RunOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    RunResults results;
    results.experiment = experiment;
    results.system = read_system_facts();
    results.command = options.command;
    results.experiment_text = options.experiment_text;
    results.started = utc_now();

    const std::unique_ptr<GlContext> context = GlContext::create(options.backend);
    describe_context(context->info(), results);
    const ReferenceCache cache(options.cache_dir);
    const CellStore cells(options.output / "cells");
    ProgressLine progress;
    const auto stopped = [&] { return options.stop && options.stop->load(); };

    const double part = 1.0 / static_cast<double>(experiment.scenes.size());
    for (std::size_t i = 0; i < experiment.scenes.size() && !stopped(); ++i) {
        const ExperimentScene& entry = experiment.scenes[i];
        const double from = part * static_cast<double>(i);
        const SceneRunControl control{*context,           cache, cells, progress, options.stop, options.threads,
                                      {from, from + part}};
        try {
            run_scene(experiment, entry, scenes.load(entry.scene), options, control, results);
        } catch (const std::exception& error) {
            results.failures.push_back({entry.scene, error.what()});
        }
        scenes.release(entry.scene);
    }
    progress.clear();
    results.interrupted = stopped();
    results.summary = summarise(results);
    Climb climbed = climb(read_ladders(experiment), results);
    results.waterfalls = std::move(climbed.waterfalls);
    std::ranges::move(climbed.gaps, std::back_inserter(results.summary));
    results.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    write_result_files(results, options.output);
    if (!results.interrupted) cells.clear();
    return results;
}

}  // namespace plumb

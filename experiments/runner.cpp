#include "experiments/runner.h"

#include <chrono>
#include <exception>

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

}  // namespace

RunResults run_experiment(const Experiment& experiment, const SceneFinder& finder, const RunOptions& options) {
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
        try {
            const Scene scene = finder.load(entry.scene);
            results.scene_hashes[entry.scene] = fmt::format("{:016x}", scene.content_hash());
            const double from = part * static_cast<double>(i);
            // A frame of a path takes about as long as a view.
            const auto views = static_cast<double>(views_of(entry, scene).size());
            double frames = views;
            for (const ExperimentPath& path : entry.paths) frames += path.frames;
            const ProgressPart all{from, from + part};
            SceneRunControl control{
                *context, cache, cells, progress, options.stop, options.threads, all.part(0.0, views / frames)};
            {
                SceneRun run(experiment, entry, scene, control);
                run.run(results);
                write_pictures(run, experiment, entry.scene, options.output, results);
                if (options.write_frames) write_frames(run, experiment, entry.scene, options.output);
            }
            double done = views;
            for (const ExperimentPath& path : entry.paths) {
                if (stopped()) break;
                control.part = all.part(done / frames, (done + path.frames) / frames);
                done += path.frames;
                try {
                    PathRun(experiment, entry, scene, path, control, options.output).run(results);
                } catch (const std::exception& error) {
                    results.failures.push_back({fmt::format("{} / {}", entry.scene, path.path), error.what()});
                }
            }
        } catch (const std::exception& error) {
            results.failures.push_back({entry.scene, error.what()});
        }
    }
    progress.clear();
    results.interrupted = stopped();
    results.summary = summarise(results);
    results.waterfalls = climb(read_ladders(experiment), results);
    results.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    write_result_files(results, options.output);
    if (!results.interrupted) cells.clear();
    return results;
}

}  // namespace plumb
